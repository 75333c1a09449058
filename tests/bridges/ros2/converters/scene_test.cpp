// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::CdrReader;
using test::converted;

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
