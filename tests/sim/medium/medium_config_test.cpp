// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/medium_config.hpp"

#include <gmock/gmock.h>

#include "sim/medium/sea_water.hpp"
#include "sim/medium/water_column.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

using test_support::error_of;
using testing::HasSubstr;

TEST(Current, KeysOfOtherTypesAreRefused) {
  EXPECT_THAT(error_of("{water: {}, current: [{type: vortex, std_mps: 1}]}"),
              HasSubstr("'std_mps' does not apply to type vortex"));
  EXPECT_THAT(error_of("{water: {}, current: [{type: grid}]}"), HasSubstr("needs either 'file' or both"));
  EXPECT_THAT(error_of("{water: {}, current: [{type: profile}]}"), HasSubstr("needs the key 'profile'"));
}

TEST(Waves, ThatWouldBreakAreRefused) {
  // 0.142 of 39.02 m; g 4^2 / (2 pi 15); 0.6 of 2 m.
  EXPECT_THAT(error_of("{water: {}, waves: {type: regular, height_m: 6, period_s: 5}}"),
              HasSubstr("'height_m' 6 is above the breaking limit of a wave of 5 s, 5.54 m"));
  EXPECT_THAT(error_of("{water: {}, waves: {hs_m: 2, tp_s: 4}}"),
              HasSubstr("is above the breaking limit of a sea with 'tp_s' 4, 1.664 m"));
  EXPECT_THAT(error_of("{water: {}, waves: {hs_m: 2, tp_s: 8, water_depth_m: 2}}"), HasSubstr("0.6 of the depth"));
  EXPECT_THAT(error_of("{water: {}, waves: {tp_s: 0}}"), HasSubstr("'tp_s' must be >= 0.2"));
  EXPECT_THAT(error_of("{water: {}, waves: {type: regular, hs_m: 1}}"),
              HasSubstr("'hs_m' does not apply to type regular"));
  EXPECT_THAT(error_of("{water: {}, waves: {sea_state: 3, hs_m: 1}}"), HasSubstr("leave out 'hs_m' and 'tp_s'"));
}

TEST(Waves, NeedGravityAndSayWhatItIs) {
  const auto error = [](double gravity_mps2) -> std::string {
    try {
      const sim::Medium medium(test_support::read_medium("{water: {}, waves: {}}"), gravity_mps2, 1);
    } catch (const sim::ConfigError& bad) {
      return bad.what();
    }
    return "";
  };
  EXPECT_THAT(error(-9.81), testing::HasSubstr("medium: waves: waves need 'gravity_mps2' above 0, got -9.81"));
  EXPECT_THAT(error(0), testing::HasSubstr("above 0, got 0"));
  EXPECT_EQ(error(9.81), "");
}

TEST(Water, BadColumnsAreRefused) {
  EXPECT_THAT(error_of("water: {profile: [{depth_m: 5}, {depth_m: 5}]}"), HasSubstr("must increase from row to row"));
  EXPECT_THAT(error_of("water: {profile: [{depth_m: -5}]}"), HasSubstr("'depth_m' must be >= 0"));
  EXPECT_THAT(error_of("water: {profile: [{depth_m: 0, density_kgpm3: 1000}, {depth_m: 5}]}"),
              HasSubstr("'density_kgpm3' must be in all rows"));
  EXPECT_THAT(error_of("water: {density: eos80, density_kgpm3: 1000}"), HasSubstr("leave out 'density_kgpm3'"));
  EXPECT_THAT(error_of("water: {temperature_C: 4, profile: [{depth_m: 0}]}"),
              HasSubstr("does not apply to water with a 'profile'"));
  EXPECT_THAT(error_of("waves: {type: jonswap}"), HasSubstr("'waves' needs 'water'"));
}

std::string error_with_gravity(const std::string& gravity, const std::string& medium) {
  try {
    sim::load_world_text("shoal: 1\nphysics: {gravity_mps2: " + gravity + "}\nmedium: " + medium + "\n", "w.yaml");
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Water, DoesNotFallUp) {
  EXPECT_EQ(error_with_gravity("-9.81", "{water: {}}"),
            "w.yaml:2:25: physics: 'gravity_mps2' must be 0 or more in a world with water, got -9.81");
  EXPECT_EQ(error_with_gravity("-9.81", "{}"), "");
  // A tank where nothing weighs anything is good for looking at drag alone.
  EXPECT_EQ(error_with_gravity("0", "{water: {}}"), "");
}

}  // namespace
