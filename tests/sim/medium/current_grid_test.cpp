// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/current_grid.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

using sim::Vector3d;
using test_support::error_of;
using test_support::read_medium;
using testing::HasSubstr;

void write(const std::string& file, const std::string& text) {
  std::ofstream(file) << text;
}

TEST(Current, GridIsBilinearAndKnowsItsBorder) {
  const test_support::ScratchFolder folder;
  write(folder.file("flow.csv"), "x_m,y_m,east_mps,north_mps\n0,0,0,1\n10,0,1,1\n0,20,2,1\n10,20,5,1\n");
  for (const std::string outside : {"zero", "edge"}) {
    const sim::Medium medium(
        read_medium("{water: {}, current: [{type: grid, file: flow.csv, outside: " + outside + "}]}",
                    folder.file("world.yaml")),
        9.81, 1);
    // u(a, b) with a = 0.5, b = 0.25: 0.75 * 0.5 + 0.25 * 3.5.
    EXPECT_TRUE(medium.water_velocity_W({5, 5, -1}).isApprox(Vector3d(1.25, 1, 0), 1e-12));
    EXPECT_TRUE(medium.current_known({5, 5, -1}));
    EXPECT_FALSE(medium.current_known({-5, 0, -1}));
    const Vector3d beyond = outside == "zero" ? Vector3d::Zero() : Vector3d(0, 1, 0);
    EXPECT_EQ(medium.water_velocity_W({-5, 0, -1}), beyond);
  }
}

TEST(Current, GridComesFromAPairOfEsriGrids) {
  const test_support::ScratchFolder folder;
  const std::string header = "ncols 2\nnrows 2\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n";
  write(folder.file("u.asc"), header + "0 1\n2 3\n");
  write(folder.file("v.asc"), header + "0 0\n0 -9999\n");
  const sim::Medium medium(
      read_medium(
          "{water: {}, current: [{type: grid, east_file: u.asc, north_file: v.asc, map_origin_m: [1000, 2000]}]}",
          folder.file("world.yaml")),
      9.81, 1);
  // The first row of the file is the north; the hole takes its neighbor's 0.
  EXPECT_TRUE(medium.water_velocity_W({5, 0, -1}).isApprox(Vector3d(2.5, 0, 0), 1e-12));
  EXPECT_TRUE(medium.water_velocity_W({5, 10, -1}).isApprox(Vector3d(0.5, 0, 0), 1e-12));
}

TEST(Current, BadGridsAreRefusedWithTheLine) {
  const test_support::ScratchFolder folder;
  const auto error = [&](const std::string& csv) {
    write(folder.file("flow.csv"), csv);
    return error_of("{water: {}, current: [{type: grid, file: flow.csv}]}", folder.file("world.yaml"));
  };
  const std::string header = "x_m,y_m,east_mps,north_mps\n";
  EXPECT_THAT(error("x,y,u,v\n"), HasSubstr("line 1: the header must name"));
  EXPECT_THAT(error(header + "0,0,a,1\n"), HasSubstr("line 2: 'east_mps' is not a number"));
  EXPECT_THAT(error(header + "0,0,nan,1\n"), HasSubstr("line 2: 'east_mps' is not a number, got 'nan'; a grid in a CSV "
                                                       "file must have all its points"));
  EXPECT_THAT(error(header + "0,0,,1\n"), HasSubstr("line 2: 'east_mps' is not a number, got ''"));
  EXPECT_THAT(error(header + "0,0,-99,1\n0,1,1,1\n1,0,1,1\n1,1,1,1\n"),
              HasSubstr("has a current of 99 m/s, which is a code for a missing value"));
  EXPECT_THAT(error(header + "0,0,1\n"), HasSubstr("line 2: 'north_mps' is missing"));
  EXPECT_THAT(error(header + "0,0,1,1\n0,1,1,1\n1,0,1,1\n"), HasSubstr("one row for each of 2 x 2 points, has 3"));
  EXPECT_THAT(error(header + "0,0,1,1\n0,1,1,1\n1,0,1,1\n1,0,1,1\n"), HasSubstr("has the point 1, 0 twice"));
  EXPECT_THAT(error(header + "0,0,1,1\n1,0,1,1\n3,0,1,1\n0,1,1,1\n1,1,1,1\n3,1,1,1\n"),
              HasSubstr("is not a regular grid"));
  EXPECT_THAT(error(header + "0,0,101,1\n0,1,1,1\n1,0,1,1\n1,1,1,1\n"), HasSubstr("a current of 101 m/s"));
  EXPECT_THAT(error(""), HasSubstr("has no rows"));
}

TEST(Current, GridsAreReadAsSpreadsheetsAndGdalWriteThem) {
  const test_support::ScratchFolder folder;
  write(folder.file("flow.csv"),
        "\xef\xbb\xbfx_m,y_m,east_mps,north_mps\r\n0,0,1,0\r\n10,0,1,0\r\n0,10,1,0\r\n10,10,"
        "1,0\r\n");
  const std::string grid = "\xef\xbb\xbfncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ndx 10\ndy 10\nNODATA_value nan\n";
  write(folder.file("u.asc"), grid + "1 nan\n1 1\n");
  write(folder.file("v.asc"), grid + "0 0\n0 0\n");
  for (const char* files : {"file: flow.csv", "east_file: u.asc, north_file: v.asc"}) {
    const sim::Medium medium(
        read_medium("{water: {}, current: [{type: grid, " + std::string(files) + "}]}", folder.file("world.yaml")),
        9.81, 1);
    EXPECT_EQ(medium.water_velocity_W({7, 7, -1}), Vector3d(1, 0, 0)) << files;
  }
  write(folder.file("v.asc"), grid + "0 0\n0 zero\n");
  EXPECT_THAT(
      error_of("{water: {}, current: [{type: grid, east_file: u.asc, north_file: v.asc}]}", folder.file("world.yaml")),
      HasSubstr("v.asc' line 9: current 2 of row 2 is not a number, got 'zero'"));
}

TEST(Current, WhereABodyLeftItsFileIsSaidToTheDecimeter) {
  const test_support::ScratchFolder folder;
  write(folder.file("flow.csv"), "x_m,y_m,east_mps,north_mps\n0,0,1,0\n10,0,1,0\n0,10,1,0\n10,10,1,0\n");
  const sim::LoadedWorld loaded = sim::load_world_text(R"(
shoal: 1
medium: {water: {}, current: [{type: grid, file: flow.csv}]}
objects:
  - {name: buoy, position_m: [10.16, 3.333333333333333, 0], parts: [{shape: sphere, radius_m: 1, density_kgpm3: 500}]}
)",
                                                       folder.file("world.yaml"));
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  const test_support::LogCapture log;
  world.step();
  EXPECT_THAT(log.text(), HasSubstr("has left the file of the current at 10.2, 3.3 m"));
}

}  // namespace
