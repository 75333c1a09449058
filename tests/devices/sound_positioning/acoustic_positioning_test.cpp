// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/usbl_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"
#include "tests/devices/sound_positioning/usbl_worlds.hpp"

namespace {

using namespace usbl_worlds;

using shoal::usbl_t;

TEST(Usbl, ThroughAThermoclineTheSenderAppearsElsewhereUnlessTheWaterIsKnown) {
  const std::string water =
      "{profile: [{depth_m: 0, sound_speed_mps: 1515.80}, {depth_m: 20, sound_speed_mps: 1516.12}, "
      "{depth_m: 40, sound_speed_mps: 1483.07}, {depth_m: 200, sound_speed_mps: 1485.68}]}";
  const auto fix_with = [&](const std::string& keys, usbl_t& truth) {
    test::TestWorld test(usbl_world(", range_max_m: 2000, ping_period_s: 4" + keys, transponder("t", "[1000, 0, -50]"),
                                    "[]", "{water: " + water + "}"));
    test::Listener<usbl_t> fixes(test, "r1.s"), truths(test, "r1.s.truth");
    test.run_for(2.5);
    truth = truths.last();
    return fixes.last();
  };
  usbl_t truth{};
  const usbl_t plain = fix_with("", truth);
  EXPECT_NEAR(truth.position_m[2], -40, 1e-6);
  // The ray leaves almost horizontally, where the straight line falls by 2.3 degrees.
  EXPECT_GT(plain.elevation_rad, truth.elevation_rad + 0.005);
  EXPECT_GT(plain.range_m, truth.range_m + 3);
  const usbl_t known = fix_with(", assumed_water: " + water, truth);
  EXPECT_NEAR(known.range_m, truth.range_m, 0.05);
  EXPECT_NEAR(known.elevation_rad, truth.elevation_rad, 1e-4);
  EXPECT_NEAR(known.azimuth_rad, truth.azimuth_rad, 1e-9);
  // Water that is known with an error.
  const usbl_t warmer = fix_with(
      ", assumed_water: {profile: [{depth_m: 0, sound_speed_mps: 1515.80}, {depth_m: 25, "
      "sound_speed_mps: 1516.2}, {depth_m: 40, sound_speed_mps: 1483.07}]}",
      truth);
  EXPECT_GT(std::abs(warmer.elevation_rad - truth.elevation_rad), 1e-3);
}

}  // namespace
