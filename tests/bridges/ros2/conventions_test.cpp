// SPDX-License-Identifier: BSD-3-Clause
// What REP 103 (axes, units), 105 (frames), 117 (ranges), 118 (depth) and 145 (inertial) ask of the standard messages.

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/gps_data_t.hpp"
#include "shoal/image_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/sonar_range_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using bridges::ros2::ConverterContext;
using test::CdrReader;
using test::converted;
using test::expect_header;

constexpr float infinite = std::numeric_limits<float>::infinity();

/// A context after a scene with these devices of the vehicle auv1, and a moving arm.
ConverterContext knowing(const std::string& devices) {
  ConverterContext context;
  shoal::sim_scene_t scene{};
  scene.scene = R"({"bodies": [{"id": 4, "name": "auv1/arm", "owner": "auv1"}], "vehicles": [{"name": "auv1",
      "body": 3, "pose": [0, 0, -1, 1, 0, 0, 0], "devices": [)" +
                devices + "]}]}";
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  return context;
}

std::string device_with(const std::string& field_of_view) {
  return R"({"name": "x", "body": 3, "channels": ["auv1.x"], "field_of_view": )" + field_of_view + "}";
}

TEST(RosConventions, AMissIsInfiniteAndWhatIsTooNearIsMinusInfinite) {
  ConverterContext context = knowing(device_with(R"({"kind": "fan", "range_m": 10, "range_min_m": 0.2})"));
  const shoal::planar_lidar_t scan{1'500'000, 4, {10, 9.99f, 0.2f, 0.21f}, 0, {}, -1, 0.5f};
  for (const char* channel : {"auv1.x", "auv1.x.truth"}) {
    auto in = converted(scan, "scan", channel, &context);
    expect_header(*in, "auv1/x");
    in->skip<float>(5);
    EXPECT_EQ(in->number<float>(), 0.2f);
    EXPECT_EQ(in->number<float>(), 10);
    ASSERT_EQ(in->number<std::uint32_t>(), 4u);
    for (const float range_m : {infinite, 9.99f, -infinite, 0.21f}) EXPECT_EQ(in->number<float>(), range_m);
  }
}

TEST(RosConventions, AScannerWithoutALeastRangeHasNothingThatIsTooNear) {
  ConverterContext context = knowing(device_with(R"({"kind": "fan", "range_m": 10, "range_min_m": 0})"));
  auto in = converted(shoal::planar_lidar_t{1'500'000, 2, {0, NAN}, 0, {}, -1, 0.5f}, "scan", "auv1.x", &context);
  expect_header(*in, "auv1/x");
  in->skip<float>(7);
  in->skip<std::uint32_t>(1);
  EXPECT_EQ(in->number<float>(), 0);
  EXPECT_TRUE(std::isnan(in->number<float>()));  // erroneous
}

TEST(RosConventions, ARangeHasTheLimitsOfItsSonarAndIsAlongXOfItsFrame) {
  // An altimeter looks down.
  ConverterContext context =
      knowing(device_with(R"({"kind": "cone", "axis": [0, 0, -1], "half_angle_rad": 0.1, "range_m": 50,
                              "range_min_m": 0.5})"));
  auto in = converted(shoal::sonar_range_t{1'500'000, 7, 90, 1}, "range", "auv1.x", &context);
  expect_header(*in, "auv1/x_beam");
  EXPECT_EQ(in->number<std::uint8_t>(), 0);  // ultrasound
  for (const float value : {0.2f, 0.5f, 50.0f, 7.0f}) EXPECT_FLOAT_EQ(in->number<float>(), value);
  in->skip<float>(1);
  EXPECT_TRUE(in->at_end());
}

/// Reads frames as `parent > child`, with their poses x, y, z, qx, qy, qz, qw.
std::map<std::string, std::vector<double>> frames_of(std::optional<CdrReader> in) {
  std::map<std::string, std::vector<double>> frames;
  if (!in) return frames;
  const auto count = in->number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    in->skip<std::uint32_t>(2);
    std::string name = in->text() + " > ";
    name += in->text();
    for (int k = 0; k < 7; ++k) frames[name].push_back(in->number<double>());
  }
  EXPECT_TRUE(in->at_end());
  return frames;
}

auto near_to(std::vector<double> values) {
  std::vector<testing::Matcher<double>> each;
  for (const double value : values) each.push_back(testing::DoubleNear(value, 1e-12));
  return testing::ElementsAreArray(each);
}

TEST(RosConventions, EveryDeviceHasAFrameInItsVehicleOrInAMovingBody) {
  ConverterContext context = knowing(
      R"({"name": "lidar", "body": 3, "pose": [0.5, 0, 0, 0, 0, 0, 1], "channels": ["auv1.lidar"]},
         {"name": "gripper", "body": 4, "pose": [1, 0, 0, 1, 0, 0, 0], "channels": []},
         {"name": "gps", "body": 3, "pose": [0, 0, 0, 1, 0, 0, 0], "channels": ["fixes"]},
         {"name": "camera", "body": 3, "pose": [0, 0, 0, 1, 0, 0, 0], "channels": ["auv1.camera"],
          "field_of_view": {"kind": "frustum", "range_m": 100}},
         {"name": "altimeter", "body": 3, "pose": [0, 0, 0, 1, 0, 0, 0], "channels": ["auv1.altimeter"],
          "field_of_view": {"kind": "cone", "axis": [0, 0, -1], "half_angle_rad": 0.1, "range_m": 50}},
         {"name": "odom", "body": 3, "channels": ["auv1.odom"], "origin": [0, 0, 0, 1, 0, 0, 0]},
         {"name": "lost", "body": 9, "channels": []}, 7)");
  const auto frames = frames_of(converted(shoal::sim_scene_t{}, "/tf_static", "sim.scene", &context));
  EXPECT_EQ(frames.size(), 8u);  // odometry is of the vehicle, and nothing is known of the body of `lost`
  // The vehicle frame is 1 m below that of its first body.
  EXPECT_THAT(frames.at("auv1 > auv1/lidar"), near_to({0.5, 0, 1, 0, 0, 1, 0}));
  EXPECT_THAT(frames.at("auv1/body/arm > auv1/gripper"), near_to({1, 0, 0, 0, 0, 0, 1}));
  EXPECT_THAT(frames.at("auv1 > fixes"), near_to({0, 0, 1, 0, 0, 0, 1}));
  // REP 103: z ahead, x to the right, y down.
  EXPECT_THAT(frames.at("auv1/camera > auv1/camera_optical"), near_to({0, 0, 0, -0.5, 0.5, -0.5, 0.5}));
  // A quarter turn about y takes x to -z.
  EXPECT_THAT(frames.at("auv1/altimeter > auv1/altimeter_beam"),
              near_to({0, 0, 0, 0, std::sqrt(0.5), 0, std::sqrt(0.5)}));
  EXPECT_FALSE(converted(shoal::sim_scene_t{}, "/tf_static", "sim.scene"));
}

TEST(RosConventions, WheelOdometryIsThePoseOfTheVehicleInAFrameWhereItStarted) {
  ConverterContext context;
  const shoal::odometry_t odometry{1'500'000, 3, 4, M_PI, 0.5, 0.25, 0, 0};
  auto in = converted(odometry, "odometry", "a.odometry", &context);
  expect_header(*in, "a/odom");
  EXPECT_EQ(in->text(), "a");
  for (const double value : {3.0, 4.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  in->skip<double>(1 + 36);
  for (const double value : {0.5, 0.0, 0.0, 0.0, 0.0, 0.25}) EXPECT_EQ(in->number<double>(), value);
  // The scene tells where that is, also for vehicles by `count` and those that came later.
  context = knowing(
      R"({"name": "odometry", "type": "odometry", "body": 3, "channels": ["auv1.odometry"],
          "origin": [1, 2, 0, 0, 0, 0, 1]})");
  const auto frames = frames_of(converted(shoal::sim_scene_t{}, "/tf_static", "sim.scene", &context));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_THAT(frames.at("world > auv1/odom"), near_to({1, 2, 0, 0, 0, 1, 0}));
  // They come again with each sim.info.
  EXPECT_EQ(frames_of(converted(shoal::sim_info_t{}, "/tf_static", "sim.info", &context)), frames);
}

TEST(RosConventions, AnEstimateOfAClientIsThePoseOfItsVehicle) {
  // Also where the channel tells no vehicle: the channel itself.
  shoal::pose_t pose{};
  pose.utime = 1'500'000;
  pose.orientation[0] = 1;
  for (const auto& [channel, frame] : {std::pair{"rover1.estimate", "rover1"}, {"guess", "guess"}}) {
    auto in = converted(pose, "odometry", channel);
    expect_header(*in, "world");
    EXPECT_EQ(in->text(), frame);
  }
}

TEST(RosConventions, OnlyADeviceOrAnEstimateTellsThePoseOfAVehicle) {
  ConverterContext context = knowing(device_with("{}"));
  shoal::pose_t pose{};
  pose.utime = 1'500'000;
  pose.orientation[0] = 1;
  for (const auto& [channel, frame] : {std::pair{"rover1.goal", "rover1/goal"}, {"auv1.x", "auv1"}}) {
    auto in = converted(pose, "odometry", channel, &context);
    expect_header(*in, "world");
    EXPECT_EQ(in->text(), frame);
  }
}

TEST(RosConventions, AnOrientationHasTheLengthOneOrIsNone) {
  // Heading north at 1 m/s, with a quaternion of the length 2 sqrt(2).
  shoal::pose_t pose{1'500'000, {0, 0, 0}, {0, 1, 0}, {2, 0, 0, 2}, {0, 0, 0}, {0, 0, 0}};
  auto in = converted(pose, "odometry", "auv1.estimate");
  expect_header(*in, "world");
  in->text();
  in->skip<double>(3);
  const double half = std::sqrt(0.5);
  for (const double value : {0.0, 0.0, half, half}) EXPECT_NEAR(in->number<double>(), value, 1e-12);
  in->skip<double>(36);
  for (const double value : {1.0, 0.0, 0.0}) EXPECT_NEAR(in->number<double>(), value, 1e-12);
  for (const double none : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (double& each : pose.orientation) each = none;
    EXPECT_FALSE(converted(pose, "odometry", "auv1.estimate")) << none;
  }
}

TEST(RosConventions, AnImuWithoutOrientationSaysSo) {
  auto in = converted(shoal::imu_t{1'500'000, {1, 2, 3}, {4, 5, 6}}, "imu");
  expect_header(*in, "auv1/x");
  for (const double value : {0.0, 0.0, 0.0, 1.0, -1.0}) EXPECT_EQ(in->number<double>(), value);
}

TEST(RosConventions, TheCourseIsFromNorthAndTheVelocityHasEastFirst) {
  shoal::gps_data_t gps{};
  gps.utime = 1'500'000;
  EXPECT_FALSE(converted(gps, "velocity", "auv1.gps"));  // no fix
  gps.gps_lock = 1;
  gps.speed = 2;
  gps.heading = M_PI / 6;  // 30 degrees from north towards east
  auto in = converted(gps, "velocity", "auv1.gps");
  expect_header(*in, "world");
  EXPECT_NEAR(in->number<double>(), 1, 1e-12);
  EXPECT_NEAR(in->number<double>(), std::sqrt(3), 1e-12);
  for (int i = 0; i < 4 + 36; ++i) EXPECT_EQ(in->number<double>(), 0);
  EXPECT_TRUE(in->at_end());
}

TEST(RosConventions, WithoutAFixTheCovarianceIsUnknown) {
  shoal::gps_data_t gps{};
  gps.utime = 1'500'000;
  gps.latitude = gps.horizontal_accuracy = gps.vertical_accuracy = NAN;
  auto in = converted(gps, "fix", "auv1.gps");
  expect_header(*in, "auv1/gps");
  EXPECT_EQ(in->number<std::int8_t>(), -1);
  in->skip<std::uint16_t>(1);
  EXPECT_TRUE(std::isnan(in->number<double>()));
  in->skip<double>(2);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(in->number<double>(), 0);
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
}

shoal::image_t image_of(std::int32_t pixelformat, const std::string& key, const std::string& value) {
  shoal::image_t image{};
  image.utime = 1'500'000;
  image.width = 2;
  image.height = 1;
  image.row_stride = 4;
  image.pixelformat = pixelformat;
  image.data = {1, 2, 3, 4};
  image.size = 4;
  image.nmetadata = 1;
  image.metadata.resize(1);
  image.metadata[0].key = key;
  image.metadata[0].n = static_cast<std::int32_t>(value.size());
  image.metadata[0].value.assign(value.begin(), value.end());
  return image;
}

TEST(RosConventions, SixteenBitsAreBrightnessDepthsOrLabels) {
  constexpr std::int32_t le_grey16 = 909199180, png = 541544016;
  const auto encoding = [](const std::string& key) {
    auto in = converted(image_of(le_grey16, key, "mm"), "image");
    expect_header(*in, "auv1/x_optical");
    in->skip<std::uint32_t>(2);
    return in->text();
  };
  EXPECT_EQ(encoding("exposure"), "mono16");
  EXPECT_EQ(encoding("unit"), "16UC1");  // REP 118
  EXPECT_EQ(encoding("labels"), "16UC1");
  auto in = converted(image_of(png, "unit", "mm"), "compressed");
  expect_header(*in, "auv1/x_optical");
  EXPECT_EQ(in->text(), "16UC1; png compressed ");
}

/// Reads the calibration: model; D; K; R; P.
void expect_camera_info(const std::string& optics, const std::string& model, const std::vector<double>& d) {
  auto in = converted(image_of(1497715271, "optics", optics), "camera_info");
  ASSERT_TRUE(in) << optics;
  expect_header(*in, "auv1/x_optical");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);  // height
  EXPECT_EQ(in->number<std::uint32_t>(), 2u);
  EXPECT_EQ(in->text(), model);
  ASSERT_EQ(in->number<std::uint32_t>(), d.size());
  for (const double value : d) EXPECT_EQ(in->number<double>(), value);
  // The principal point of OpenCV and ROS counts from the center of the first pixel.
  for (const double value : {300.0, 0.0, 0.5, 0.0, 310.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  for (const double value : {1, 0, 0, 0, 1, 0, 0, 0, 1}) EXPECT_EQ(in->number<double>(), value);
  for (const double value : {300.0, 0.0, 0.5, 0.0, 0.0, 310.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0})
    EXPECT_EQ(in->number<double>(), value);
  in->skip<std::uint32_t>(6);
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
  EXPECT_TRUE(in->at_end());
}

TEST(RosConventions, AnImageHasTheCalibrationOfItsLens) {
  const std::string size = "width: 2, height: 1, focal_px: [300, 310], principal_px: [1, 0.5], ";
  expect_camera_info("{lens: pinhole, " + size + "distortion: [0.1, -0.2]}", "plumb_bob", {0.1, -0.2, 0, 0, 0});
  expect_camera_info("{lens: fisheye, " + size + "distortion: [], max_angle_deg: 90}", "equidistant", {0, 0, 0, 0});
  // The right camera of a stereo pair: -fx B.
  shoal::image_t right = image_of(1497715271, "optics", "{" + size + "distortion: []}");
  const std::string baseline = "0.12";
  right.metadata.push_back(
      {"baseline_m", static_cast<std::int32_t>(baseline.size()), {baseline.begin(), baseline.end()}});
  right.nmetadata = 2;
  auto in = converted(right, "camera_info");
  expect_header(*in, "auv1/x_optical");
  in->skip<std::uint32_t>(2);
  in->text();
  in->skip<double>(in->number<std::uint32_t>() + 9 + 9);
  for (const double value : {300.0, 0.0, 0.5, -300 * 0.12, 0.0, 310.0}) EXPECT_EQ(in->number<double>(), value);
  // Images of others may have no lens, or anything in its place.
  for (const char* optics : {"", "[", "{focal_px: [1]}", "{focal_px: [1, 1], principal_px: 3}", "\x01"})
    EXPECT_FALSE(converted(image_of(1497715271, "optics", optics), "camera_info")) << optics;
  EXPECT_FALSE(converted(image_of(1497715271, "exposure", "1"), "camera_info"));
}

}  // namespace
