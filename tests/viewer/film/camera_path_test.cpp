// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/camera_path.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

viewer::CameraPath read(const std::string& text) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("path.yaml")) << text;
  return viewer::read_camera_path(folder.file("path.yaml"));
}

std::string path_error(const std::string& text) {
  try {
    read(text);
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CameraPath, GoesThroughItsKeysAndStaysAtTheEnds) {
  const viewer::CameraPath path = read(
      "keys:\n"
      "  - {at_s: 0, eye_m: [0, 0, 5], look_m: [10, 0, 0], fov_deg: 60}\n"
      "  - {at_s: 10, eye_m: [10, 0, 5], look_m: [20, 0, 0], fov_deg: 30}\n"
      "  - {at_s: 30, eye_m: [30, 0, 5], look_m: [40, 0, 0]}\n");
  EXPECT_EQ(path.at(-1).eye_m, sim::Vector3d(0, 0, 5));
  EXPECT_TRUE(path.at(10).eye_m.isApprox(sim::Vector3d(10, 0, 5)));
  EXPECT_EQ(path.at(99).eye_m, sim::Vector3d(30, 0, 5));
  EXPECT_NEAR(path.at(5).fov_rad, sim::degrees_to_radians(45), 1e-12);
  // Keys on a line with a constant speed: so is the cubic.
  for (const double t : {2.5, 7.0, 12.0, 29.0}) EXPECT_NEAR(path.at(t).eye_m.x(), t, 1e-9) << t;
}

TEST(CameraPath, NamesTheLineOfAMistake) {
  EXPECT_THAT(path_error("keys:\n  - {at_s: 0, eye_m: [0, 0, 5], look_m: [0, 0, 5]}\n"), HasSubstr("path.yaml:2:"));
  EXPECT_THAT(path_error("keys:\n  - {at_s: 5, eye_m: [0, 0, 5], look_m: [0, 0, 0]}\n"
                         "  - {at_s: 5, eye_m: [0, 0, 5], look_m: [0, 0, 0]}\n"),
              HasSubstr("'at_s' must increase from key to key"));
  EXPECT_THAT(path_error("keys: []\n"), HasSubstr("must have at least one key"));
  EXPECT_THAT(path_error("key: []\n"), HasSubstr("unknown key 'key'"));
}

}  // namespace
