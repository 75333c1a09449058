// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/battery_t.hpp"
#include "shoal/dvl_t.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/image_t.hpp"
#include "shoal/multibeam_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/point_cloud_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_event_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/sonar_range_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;
using test::CdrReader;
using test::converted;
using test::expect_header;

TEST(Ros2Converter, TimeBeforeTheEpochHasPositiveNanoseconds) {
  auto in = converted(shoal::utime_t{-1}, "/clock", "sim.clock");
  EXPECT_EQ(in->number<std::int32_t>(), -1);
  EXPECT_EQ(in->number<std::uint32_t>(), 999'999'000u);
}

TEST(Ros2Converter, TimesBeyondTheRangeOfRosAreItsEnds) {
  // 2040-01-01: seconds are 32-bit numbers.
  auto in = converted(shoal::utime_t{2'208'988'800'000'000}, "/clock", "sim.clock");
  EXPECT_EQ(in->number<std::int32_t>(), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(in->number<std::uint32_t>(), 0u);
  in = converted(shoal::utime_t{std::numeric_limits<std::int64_t>::min()}, "/clock", "sim.clock");
  EXPECT_EQ(in->number<std::int32_t>(), std::numeric_limits<std::int32_t>::min());
}

TEST(Ros2Converter, OnlyTheClockOfTheSimulatorIsTheClock) {
  EXPECT_TRUE(converted(shoal::utime_t{5}, "/clock", "sim.clock"));
  EXPECT_FALSE(converted(shoal::utime_t{5}, "/clock", "auv1.beat"));
}

TEST(Ros2Converter, PosesOfVehiclesAreTransformsWithWLast) {
  shoal::sim_state_t state{1'500'000, 0, 1, {"auv1"}, {{1, 2, 3}}, {{0.5, -0.5, 0.5, 0.25}}, {{0, 0, 0}}, {{0, 0, 0}}};
  auto in = converted(state, "/tf");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "auv1");
  for (const double value : {1.0, 2.0, 3.0, -0.5, 0.5, 0.25, 0.5}) EXPECT_EQ(in->number<double>(), value);
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, AFixHasVariancesOfItsAccuracy) {
  shoal::gps_data_t gps{};
  gps.utime = 1'500'000;
  gps.gps_lock = 2;
  gps.latitude = 47;
  gps.longitude = 8;
  gps.elev = 400;
  gps.horizontal_accuracy = 3;
  gps.vertical_accuracy = 5;
  auto in = converted(gps, "fix", "auv1.gps");
  expect_header(*in, "auv1/gps");
  EXPECT_EQ(in->number<std::int8_t>(), 2);  // ground-based augmentation
  EXPECT_EQ(in->number<std::uint16_t>(), 1);
  for (const double value : {47.0, 8.0, 400.0, 9.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 25.0})
    EXPECT_EQ(in->number<double>(), value);
  EXPECT_EQ(in->number<std::uint8_t>(), 2);  // the diagonal is known
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, TheLastBeamOfAScanIsAtItsLargestAngle) {
  auto in = converted(shoal::planar_lidar_t{1'500'000, 3, {1, 2, 3}, 0, {}, -1.0f, 0.5f}, "scan");
  expect_header(*in, "auv1/x");
  for (const float value : {-1.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.0f}) EXPECT_EQ(in->number<float>(), value);
  EXPECT_EQ(in->number<float>(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(in->number<std::uint32_t>(), 3u);
  for (const float value : {1.0f, 2.0f, 3.0f}) EXPECT_EQ(in->number<float>(), value);
  EXPECT_EQ(in->number<std::uint32_t>(), 0u);
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, PointsHaveTheirColumns) {
  auto in = converted(shoal::point_cloud_t{1'500'000, 1, {1}, {2}, {3}, {0.5f}, {7}, {-20}}, "points");
  expect_header(*in, "auv1/x");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  ASSERT_EQ(in->number<std::uint32_t>(), 6u);
  std::uint32_t end = 0;
  for (const char* name : {"x", "y", "z", "intensity", "time_us", "ring"}) {
    EXPECT_EQ(in->text(), name);
    EXPECT_EQ(in->number<std::uint32_t>(), end);
    const int datatype = in->number<std::uint8_t>();
    end += datatype == 4 ? 2 : 4;
    EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  }
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
  EXPECT_EQ(in->number<std::uint32_t>(), end);
  EXPECT_EQ(in->number<std::uint32_t>(), end);
  ASSERT_EQ(in->number<std::uint32_t>(), 22u);
  in->skip<std::uint8_t>(22);
  EXPECT_EQ(in->number<std::uint8_t>(), 1);
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, OnlyBeamsWithAnEchoArePoints) {
  shoal::multibeam_t ping{1'500'000, 2, {0.0f, 0.5f}, {10.0f, 20.0f}, {60.0f, 70.0f}, {0, 1}};
  auto in = converted(ping, "points");
  expect_header(*in, "auv1/x");
  in->number<std::uint32_t>();
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);  // width
  ASSERT_EQ(in->number<std::uint32_t>(), 4u);
  for (int i = 0; i < 4; ++i) {
    in->text();
    in->number<std::uint32_t>();
    in->number<std::uint8_t>();
    in->number<std::uint32_t>();
  }
  in->skip<std::uint8_t>(1);
  in->skip<std::uint32_t>(2);
  ASSERT_EQ(in->number<std::uint32_t>(), 16u);
  EXPECT_EQ(in->number<float>(), 0.0f);
  EXPECT_FLOAT_EQ(in->number<float>(), 20.0f * std::sin(0.5f));   // to port
  EXPECT_FLOAT_EQ(in->number<float>(), -20.0f * std::cos(0.5f));  // down
  EXPECT_EQ(in->number<float>(), 70.0f);
}

TEST(Ros2Converter, ImagesAreRawOrCompressedByTheirFormat) {
  shoal::image_t image{};
  image.utime = 1'500'000;
  image.width = 2;
  image.height = 1;
  image.row_stride = 6;
  image.pixelformat = 859981650;  // RGB
  image.size = 6;
  image.data = {1, 2, 3, 4, 5, 6};
  auto in = converted(image, "image");
  EXPECT_FALSE(converted(image, "compressed"));
  expect_header(*in, "auv1/x_optical");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  EXPECT_EQ(in->number<std::uint32_t>(), 2u);
  EXPECT_EQ(in->text(), "rgb8");
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
  EXPECT_EQ(in->number<std::uint32_t>(), 6u);
  EXPECT_EQ(in->number<std::uint32_t>(), 6u);
  image.row_stride = 5;
  EXPECT_FALSE(converted(image, "image"));  // rows overlap
  image.pixelformat = 1196444237;           // JPEG
  auto jpeg = converted(image, "compressed");
  expect_header(*jpeg, "auv1/x_optical");
  EXPECT_EQ(jpeg->text(), "jpeg");
}

TEST(Ros2Converter, AnEstimateIsAPoseInTheWorldWithItsCovariance) {
  shoal::estimate_t estimate{1'500'000, {1, 2, 3}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 0, 0}, M_PI, 0};
  auto in = converted(estimate, "pose");
  expect_header(*in, "world");
  for (const double value : {1.0, 2.0, 3.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  EXPECT_NEAR(in->number<double>(), 0.0, 1e-15);  // cos(pi/2)
  const double rows[3][6] = {{1, 2, 3, 0, 0, 0}, {4, 5, 6, 0, 0, 0}, {7, 8, 9, 0, 0, 0}};
  for (const auto& row : rows)
    for (const double value : row) EXPECT_EQ(in->number<double>(), value);
  in->skip<double>(18);
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, VelocitiesOfOdometryAreInTheAxesOfTheVehicle) {
  // Heading north (yaw 90 degrees) with 2 m/s to the north: forward.
  const double half = std::sqrt(0.5);
  shoal::pose_t pose{1'500'000, {0, 0, 0}, {0, 2, 0}, {half, 0, 0, half}, {0, 0, 1}, {0, 0, 0}};
  auto in = converted(pose, "odometry", "auv1.estimate");
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "auv1");
  in->skip<double>(7 + 36);
  for (const double value : {2.0, 0.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_NEAR(in->number<double>(), value, 1e-12);
  in->skip<double>(36);
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, ASonarWithoutAnEchoReportsAnInfiniteRange) {
  auto in = converted(shoal::sonar_range_t{1'500'000, 50, 0, 0}, "range");
  expect_header(*in, "auv1/x");
  in->skip<std::uint8_t>(1);
  in->skip<float>(3);
  EXPECT_EQ(in->number<float>(), std::numeric_limits<float>::infinity());
}

TEST(Ros2Converter, ADischargingBatteryHasANegativeCurrent) {
  auto in = converted(shoal::battery_t{1'500'000, 12, 2, 0.5, 0, 0}, "battery");
  expect_header(*in, "auv1/x");
  EXPECT_EQ(in->number<float>(), 12.0f);
  EXPECT_TRUE(std::isnan(in->number<float>()));
  EXPECT_EQ(in->number<float>(), -2.0f);
}

TEST(Ros2Converter, ADvlWithoutBottomLockGivesNoVelocity) {
  shoal::dvl_t dvl{};
  EXPECT_FALSE(converted(dvl, "velocity"));
  dvl.bottom_lock = 1;
  EXPECT_TRUE(converted(dvl, "velocity"));
}

TEST(Ros2Converter, BodiesAreTransformsNamedByTheSceneBefore) {
  ConverterContext context;
  shoal::sim_scene_t scene{};
  scene.revision = 3;
  scene.scene = R"({"bodies": [{"id": 4, "name": "a/arm", "owner": "a"}, {"id": 6, "name": "ball", "owner": ""}, 7]})";
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  shoal::sim_bodies_t bodies{1'500'000,
                             0,
                             0,
                             3,
                             3,
                             {4, 5, 6},
                             {{1, 2, 3}, {0, 0, 0}, {4, 5, 6}},
                             {{0.5f, -0.5f, 0.5f, 0.25f}, {1, 0, 0, 0}, {1, 0, 0, 0}}};
  auto in = converted(bodies, "/tf", "sim.bodies", &context);
  ASSERT_EQ(in->number<std::uint32_t>(), 2u);  // body 5 is not in the scene
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "a/body/arm");
  for (const double value : {1.0, 2.0, 3.0, -0.5, 0.5, 0.25, 0.5}) EXPECT_EQ(in->number<double>(), value);
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "body/ball");
  bodies.revision = 4;
  EXPECT_FALSE(converted(bodies, "/tf", "sim.bodies", &context));  // of a scene that is not known
  scene.scene = "[";
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  EXPECT_TRUE(context.body_frames.empty());
}

TEST(Ros2Converter, AFaultIsAWarningInTheLog) {
  auto in = converted(shoal::sim_event_t{1'500'000, 0, "fault", "a/lidar", "stuck"}, "/rosout", "sim.event");
  EXPECT_EQ(in->number<std::int32_t>(), 1);
  EXPECT_EQ(in->number<std::uint32_t>(), 500'000'000u);
  EXPECT_EQ(in->number<std::uint8_t>(), 30);
  EXPECT_EQ(in->text(), "a/lidar");
  EXPECT_EQ(in->text(), "fault: stuck");
}

TEST(Ros2Converter, TheTopicIsBelowTheChannelOrCommon) {
  EXPECT_EQ((Converter{"", "", "scan", {}}.topic_for("rover1.lidar")), "/rover1/lidar/scan");
  EXPECT_EQ((Converter{"", "", "/tf", {}}.topic_for("sim.state")), "/tf");
}

/// Reads a marker: its namespace and type; its other members are not examined.
std::string next_marker(CdrReader& in) {
  in.skip<std::int32_t>(1);
  in.skip<std::uint32_t>(1);
  const std::string frame = in.text(), name = in.text();
  const auto id = in.number<std::int32_t>(), type = in.number<std::int32_t>(), action = in.number<std::int32_t>();
  std::string read = frame + " " + name + " " + std::to_string(id) + " type " + std::to_string(type);
  if (action != 0) read = "action " + std::to_string(action);
  const double x_m = in.number<double>();
  in.skip<double>(6);
  const double width_m = in.number<double>();
  in.skip<double>(2);
  const float red = in.number<float>();
  in.skip<float>(3);
  in.skip<std::uint32_t>(2);
  EXPECT_EQ(in.number<std::uint8_t>(), 1);  // locked to its frame
  const auto points = in.number<std::uint32_t>();
  in.skip<double>(static_cast<int>(3 * points));
  in.skip<std::uint32_t>(1);  // colors
  in.text();                  // texture
  in.skip<std::uint32_t>(2);
  in.text();
  in.text();
  in.skip<std::uint32_t>(2);
  for (int i = 0; i < 3; ++i) in.text();
  in.skip<std::uint32_t>(1);
  in.number<std::uint8_t>();
  if (action != 0) return read;
  return read + " x " + std::to_string(static_cast<int>(x_m)) + " width " + std::to_string(static_cast<int>(width_m)) +
         " red " + std::to_string(std::lround(100 * red)) + " points " + std::to_string(points);
}

std::vector<std::string> markers_of(std::optional<CdrReader> in) {
  std::vector<std::string> markers;
  if (!in) return markers;
  markers.resize(in->number<std::uint32_t>());
  for (std::string& marker : markers) marker = next_marker(*in);
  EXPECT_TRUE(in->at_end());
  return markers;
}

TEST(Converter, PartsOfASceneAreMarkersInTheFramesOfTheirBodies) {
  shoal::sim_scene_t scene{};
  scene.scene = R"({"materials":[{"name":"m","color":"#ff0000"}],"bodies":[
      {"id":0,"name":"auv1/hull","owner":"auv1","fixed":false,"pose":[9,0,0,1,0,0,0],"parts":[
        {"shape":"box","size_m":[2,1,1],"pose":[3,0,0,1,0,0,0],"material":0},
        {"shape":"capsule","radius_m":2,"length_m":1,"pose":[0,0,0,1,0,0,0],"color":"#100000"}]},
      {"id":1,"name":"wall","owner":"wall","fixed":true,"pose":[5,0,0,1,0,0,0],"parts":[
        {"shape":"sphere","radius_m":4,"pose":[1,0,0,1,0,0,0],"color":"#200000"}]}],
      "water":{"level_m":1},"zones":[{"name":"z","polygon_m":[[0,0],[1,0],[1,1]]}]})";
  EXPECT_THAT(markers_of(converted(scene, "/scene", "sim.scene")),
              testing::ElementsAre("action 3", "auv1/body/hull auv1/body/hull 0 type 1 x 3 width 2 red 100 points 0",
                                   "auv1/body/hull auv1/body/hull 3 type 3 x 0 width 4 red 6 points 0",
                                   "auv1/body/hull auv1/body/hull 4 type 2 x 0 width 4 red 6 points 0",
                                   "auv1/body/hull auv1/body/hull 5 type 2 x 0 width 4 red 6 points 0",
                                   "world wall/body/wall 0 type 2 x 6 width 8 red 13 points 0",
                                   "world water 0 type 1 x 0 width 400 red 15 points 0",
                                   "world zones 0 type 4 x 0 width 0 red 90 points 4"));
  scene.scene = R"({"bodies":[3,{"parts":[{"shape":"box"},7]}],"zones":{},"water":5})";
  EXPECT_THAT(markers_of(converted(scene, "/scene", "sim.scene")), testing::ElementsAre("action 3"));
  scene.scene = "[";
  EXPECT_FALSE(converted(scene, "/scene", "sim.scene"));
}

TEST(Converter, AMeshBecomesAMarkerWhenItsAssetArrives) {
  shoal::sim_scene_t scene{};
  scene.scene = R"({"bodies":[{"id":0,"name":"rock","owner":"rock","fixed":true,"parts":[
      {"shape":"mesh","asset":"00000000000000aa","color":"#400000"}]}]})";
  shoal::sim_asset_t asset{};
  asset.hash = "00000000000000aa";
  const auto put = [&asset](auto number) {
    const auto* const from = reinterpret_cast<const std::uint8_t*>(&number);
    asset.data.insert(asset.data.end(), from, from + sizeof number);
  };
  for (const std::uint32_t number : {1u, 3u, 1u}) put(number);  // a mesh: vertices, triangles
  for (const float number : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) put(number);
  for (const std::uint32_t number : {0u, 1u, 2u}) put(number);
  asset.size = static_cast<std::int32_t>(asset.data.size());

  // Scene first, then again with the asset known
  ConverterContext context;
  EXPECT_THAT(markers_of(converted(scene, "/scene", "sim.scene", &context)), testing::ElementsAre("action 3"));
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  const std::string marker = "world rock/body/rock 0 type 11 x 0 width 1 red 25 points 3";
  EXPECT_THAT(markers_of(converted(asset, "/scene", "sim.asset", &context)), testing::ElementsAre(marker));
  EXPECT_FALSE(converted(asset, "/tf", "sim.asset", &context));
  EXPECT_FALSE(converted(asset, "/scene", "sim.asset", &context));
  EXPECT_THAT(markers_of(converted(scene, "/scene", "sim.scene", &context)), testing::ElementsAre("action 3", marker));

  // Corners that the mesh does not have
  context.assets.clear();
  asset.data[asset.data.size() - 4] = 3;
  EXPECT_FALSE(converted(asset, "/scene", "sim.asset", &context));
}

}  // namespace
