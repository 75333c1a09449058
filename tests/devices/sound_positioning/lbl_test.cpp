// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/lbl.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/lbl_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"
#include "tests/devices/sound_positioning/lbl_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace lbl_fixture;

using shoal::lbl_t;

TEST(Lbl, RequestsANetOfTransponders) {
  test::TestWorld test(lbl_world("", mooring("a", "[300, 400, -10]", ", turnaround_s: 0.1") +
                                         mooring("b", "[-500, 0, -10]", ", turnaround_s: 0.2") +
                                         mooring("c", "[0, 0, -1510]") + mooring("far", "[4000, 0, -10]") +
                                         mooring("other", "[0, 100, -10]", "", "usbl")));
  test::Listener<lbl_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(4.9);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_THAT(all[0].transponder, testing::ElementsAre("a/t", "b/t", "c/t", "far/t"));
  // At 1500 m/s; two times are whole microseconds, of 0.75 mm.
  const double distances_m[] = {500, 500, 1500};
  const lbl_t truth = truths.last();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(all[0].travel_time_s[i], 2 * distances_m[i] / 1500, 1.1e-6);
    EXPECT_NEAR(all[0].range_m[i], distances_m[i], 1e-3);
    EXPECT_NEAR(truth.range_m[i], distances_m[i], 1e-9);
  }
  // Beyond 3000 m it does not receive.
  EXPECT_TRUE(std::isnan(all[0].travel_time_s[3]) && std::isnan(all[0].range_m[3]));
}

TEST(Lbl, RangesThroughAThermoclineAreLongUnlessTheWaterIsKnown) {
  const std::string water =
      "{profile: [{depth_m: 0, sound_speed_mps: 1515.80}, {depth_m: 20, sound_speed_mps: 1516.12}, "
      "{depth_m: 40, sound_speed_mps: 1483.07}, {depth_m: 200, sound_speed_mps: 1485.68}]}";
  const auto ranges_with = [&](const std::string& keys, lbl_t& truth) {
    std::string world = lbl_world(keys, mooring("a", "[1000, 0, -50]") + mooring("b", "[0, -400, -120]"));
    const std::string uniform = "{surface_m: 0, sound_speed_mps: 1500}";
    world.replace(world.find(uniform), uniform.size(), water);
    test::TestWorld test(world);
    test::Listener<lbl_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
    test.run_for(4.5);
    truth = truths.last();
    return reports.last();
  };
  lbl_t truth{};
  const lbl_t plain = ranges_with("", truth), known = ranges_with(", assumed_water: " + water, truth);
  EXPECT_NEAR(truth.range_m[0], std::hypot(1000, 40), 1e-6);
  EXPECT_GT(plain.range_m[0], truth.range_m[0] + 3);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(known.range_m[i], truth.range_m[i], 0.002);  // two times in whole us
  // Water that is known with an error: 1 m/s of 1500 is 0.7 m at 1 km.
  const lbl_t faster = ranges_with(
      ", assumed_water: {profile: [{depth_m: 0, sound_speed_mps: 1516.80}, {depth_m: 20, "
      "sound_speed_mps: 1517.12}, {depth_m: 40, sound_speed_mps: 1484.07}, {depth_m: 200, "
      "sound_speed_mps: 1486.68}]}",
      truth);
  EXPECT_NEAR(faster.range_m[0] - truth.range_m[0], 0.67, 0.05);
}

TEST(Lbl, ATransponderThatLeavesOrIsBlockedIsNaN) {
  test::TestWorld test(lbl_world(", ping_period_s: 0.5, range_max_m: 200",
                                 mooring("a", "[150, 0, -10]") + mooring("b", "[0, 90, -10]")));
  test::Listener<lbl_t> reports(test, "r1.s");
  test.run_for(0.15);
  test.world.editor().remove_vehicle(
      "a");  // before it answers at 0.13 s its ping was received; its answer is on its way
  test.run_for(0.3);
  const lbl_t first = reports.last();
  ASSERT_EQ(first.n, 2);
  EXPECT_NEAR(first.range_m[0], 150, 1e-3);  // what was sent continues
  EXPECT_NEAR(first.range_m[1], 90, 1e-3);
  test.run_for(0.5);
  const lbl_t second = reports.last();
  EXPECT_EQ(second.n, 1);
  EXPECT_EQ(second.transponder.at(0), "b/t");
}

TEST(Lbl, SpeedsNoiseAndLossesAreAsAskedFor) {
  test::TestWorld test(lbl_world(
      ", ping_period_s: 0.05, range_max_m: 100, assumed_sound_speed_mps: 1470, time_noise: {gaussian_std: 1.0e-4}, "
      "answer_dropout: 0.2",
      mooring("a", "[15, 0, -10]")));
  test::Listener<lbl_t> reports(test, "r1.s");
  test.run_for(100);
  std::vector<double> times, ranges;
  double n = 0, missed = 0;
  for (const auto& report : reports.take_all()) {
    ++n;
    if (std::isnan(report.range_m.at(0))) {
      ++missed;
      continue;
    }
    times.push_back(report.travel_time_s.at(0));
    ranges.push_back(report.range_m.at(0) - 1470 * report.travel_time_s.at(0) / 2);
  }
  const auto in_time = test::statistics(times);
  ASSERT_GT(in_time.count, 1000);
  EXPECT_NEAR(in_time.mean, 0.02, 4 * 1e-4 / std::sqrt(in_time.count));
  EXPECT_NEAR(in_time.std, 1e-4, 4 * 1e-4 / std::sqrt(2 * in_time.count));
  EXPECT_NEAR(test::statistics(ranges).mean, 0, 1e-12);
  EXPECT_NEAR(missed / n, 0.2, 4 * std::sqrt(0.2 * 0.8 / n));
}

TEST(Lbl, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(lbl_world(", ping_period_s: 0, ping_s: 2", "")),
              testing::AllOf(testing::HasSubstr("'ping_period_s' must be >= 0.01 and <= 10000, got 0"),
                             testing::HasSubstr("'ping_s' must be >= 1e-04 and <= 1, got 2")));
}

}  // namespace
