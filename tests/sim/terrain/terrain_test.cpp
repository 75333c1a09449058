// SPDX-License-Identifier: BSD-3-Clause
#include "sim/terrain/terrain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "sim/base/crc32.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/terrain/terrain_error.hpp"

namespace {

using test::error_of;

const std::string header = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n";

TEST(Terrain, OriginIsTheMiddleTheCornerOrAPlaceOnTheMap) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("origin.asc");
  std::ofstream(path) << header << "1 2 3\n4 5 6\n";
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::ascii;
  config.file = path;
  EXPECT_EQ(sim::load_terrain(config).grid.west_m, -10);
  EXPECT_EQ(sim::load_terrain(config).grid.south_m, -5);
  config.origin = sim::TerrainConfig::Origin::corner;
  EXPECT_EQ(sim::load_terrain(config).grid.west_m, 0);
  config.origin = sim::TerrainConfig::Origin::map;
  config.map_origin_m = {110, 200};
  EXPECT_EQ(sim::load_terrain(config).grid.west_m, -5);
  EXPECT_EQ(sim::load_terrain(config).grid.south_m, 5);
  config.vertical_offset_m = -1;
  EXPECT_EQ(sim::load_terrain(config).grid.at(0, 1), 0);
  std::filesystem::remove(path);
  EXPECT_EQ(error_of([&] { sim::load_terrain(config); }), "file '" + path + "' does not exist");
}

TEST(Terrain, TheLastAreaOverTheMiddleOfACellWins) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::slope;
  config.size_m = {10, 10};
  config.areas.resize(3);
  config.areas[0].size_m = {6, 6, 0};
  config.areas[1].shape = sim::TerrainAreaConfig::Shape::circle;
  config.areas[1].radius_m = 1.5;
  config.areas[2].shape = sim::TerrainAreaConfig::Shape::polygon;
  config.areas[2].points_m = {{2, 2, 0}, {5, 2, 0}, {5, 5, 0}};
  const sim::Terrain terrain = sim::load_terrain(config);
  EXPECT_EQ(terrain.area_at(-4.5, 0), 0);
  EXPECT_EQ(terrain.area_at(-2.5, 2.5), 1);
  EXPECT_EQ(terrain.area_at(0.5, 0.5), 2);
  EXPECT_EQ(terrain.area_at(4.5, 2.7), 3);
  EXPECT_EQ(terrain.area_at(100, -100), 0);  // outside: as the nearest cell
}

}  // namespace
