// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/presets.hpp"

#include <gmock/gmock.h>

#include "tests/sim/config/parse.hpp"

namespace {

using testing::ElementsAre;

struct Lens {
  int glasses = 1;
  void read(sim::ParamReader& in) { in.read("glasses", glasses, sim::at_least(1), "how many"); }
};

struct Camera {
  std::string preset = "none";
  double range_m = 1;
  double angle_rad = 0;
  Lens lens;

  void read(sim::ParamReader& in);
};

const sim::Presets& presets() {
  static const sim::Presets all("devices/camera_presets.yaml",
                                "# A data sheet.\n"
                                "wide: {angle_deg: 90, lens: {glasses: 4}}\n"
                                "narrow:\n"
                                "  angle_deg: 10\n"
                                "  range_m: 7\n"
                                "wrong:\n"
                                "  range_m: -2\n"
                                "  rang_m: 3\n");
  return all;
}

void Camera::read(sim::ParamReader& in) {
  presets().read(in, *this, {"none"}, "a product");
  in.read("range_m", range_m, sim::above(0), "how far");
  in.read_deg("angle_deg", angle_rad, sim::between(0, 180), "how wide");
  in.read("lens", lens, "its glasses");
}

Camera camera_of(const std::string& text, sim::Diagnostics& diagnostics) {
  const sim::ConfigNode node = test::parse(text);
  sim::ParamReader in(node, "camera", diagnostics);
  Camera camera;
  camera.read(in);
  in.finish();
  return camera;
}

Camera camera_of(const std::string& text) {
  sim::Diagnostics diagnostics;
  const Camera camera = camera_of(text, diagnostics);
  EXPECT_EQ(diagnostics.lines(), std::vector<std::string>{});
  return camera;
}

TEST(Presets, AreTheDefaultsOfTheKeysThatAUserWrites) {
  const Camera narrow = camera_of("{range_m: 8, preset: narrow}");
  EXPECT_EQ(narrow.preset, "narrow");
  EXPECT_EQ(narrow.range_m, 8);
  EXPECT_EQ(narrow.angle_rad, sim::degrees_to_radians(10));
  EXPECT_EQ(camera_of("{preset: wide}").range_m, 1);
}

TEST(Presets, KeepTheKeysOfAMapBesideThoseOfTheUser) {
  EXPECT_EQ(camera_of("{preset: wide, lens: {}}").lens.glasses, 4);
  EXPECT_EQ(camera_of("{preset: wide, lens: {glasses: 2}}").lens.glasses, 2);
}

TEST(Presets, SetNothingWithAnotherName) {
  const Camera camera = camera_of("{preset: none, angle_deg: 20}");
  EXPECT_EQ(camera.range_m, 1);
  EXPECT_EQ(camera.lens.glasses, 1);
}

TEST(Presets, AreDescribedByTheirNamesInTheOrderOfTheirFile) {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  Camera camera;
  camera.read(in);
  EXPECT_THAT(table.front().choices, ElementsAre("none", "wide", "narrow", "wrong"));
  EXPECT_EQ(table.front().initial, "none");
  EXPECT_EQ(table[1].initial, "1");
}

TEST(Presets, RefuseANameThatTheFileDoesNotHave) {
  sim::Diagnostics diagnostics;
  camera_of("{preset: narow}", diagnostics);
  EXPECT_THAT(diagnostics.lines(),
              ElementsAre(testing::HasSubstr("'preset' must be one of: none, wide, narrow, wrong; got 'narow'")));
}

TEST(Presets, ReportAWrongKeyOfTheirFileAtItsLine) {
  sim::Diagnostics diagnostics;
  camera_of("{preset: wrong}", diagnostics);
  EXPECT_THAT(
      diagnostics.lines(),
      ElementsAre("devices/camera_presets.yaml:7:12: preset 'wrong': 'range_m' must be > 0, got -2",
                  testing::StartsWith("devices/camera_presets.yaml:8:3: preset 'wrong': unknown key 'rang_m'; known")));
}

TEST(Presets, RefuseAFileThatIsNotYaml) {
  EXPECT_THROW(sim::Presets("devices/camera_presets.yaml", "wide: {angle_deg: 90\n"), sim::ConfigError);
}

}  // namespace
