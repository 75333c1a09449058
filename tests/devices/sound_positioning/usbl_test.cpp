// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/usbl.hpp"

#include <gmock/gmock.h>

#include "shoal/transponder_t.hpp"
#include "shoal/usbl_t.hpp"
#include "sim/base/math.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"
#include "tests/devices/sound_positioning/usbl_worlds.hpp"

namespace {

using namespace usbl_worlds;

using shoal::usbl_t;
using test::marine_world;

TEST(Usbl, MeasuresRangeAndDirectionByThe345Triangle) {
  test::TestWorld test(usbl_world("", transponder("deep", "[30, 40, -130]") + transponder("air", "[30, 0, 1]") +
                                          transponder("far", "[2000, 0, -10]")));
  test::Listener<usbl_t> truths(test, "r1.s.truth");
  test::Listener<shoal::transponder_t> answers(test, "deep.t");
  test.run_for(0.9);
  const auto all = truths.take_all();
  ASSERT_EQ(all.size(), 1u);
  const usbl_t& fix = all[0];
  EXPECT_EQ(fix.target, "deep/t");
  EXPECT_NEAR(fix.range_m, 130, 1e-9);
  EXPECT_NEAR(fix.azimuth_rad, std::atan2(4, 3), 1e-9);
  EXPECT_NEAR(fix.elevation_rad, -std::atan2(120, 50), 1e-9);
  EXPECT_NEAR(fix.position_m[0], 30, 1e-9);
  EXPECT_NEAR(fix.position_m[1], 40, 1e-9);
  EXPECT_NEAR(fix.position_m[2], -120, 1e-9);
  const auto answer = answers.last();
  EXPECT_EQ(answer.answers, 1);
  EXPECT_EQ(answer.asked_by, "r1/s");
}

TEST(Usbl, AnswersTakeTheTimeOfSoundThereAndBack) {
  test::TestWorld test(usbl_world(", ping_period_s: 0.1", transponder("t", "[600, 0, -10]", ", turnaround_s: 0.05")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(5);
  const auto all = fixes.take_all();
  const double sound_mps = test.world.medium().sound_speed_mps({0, 0, -10});
  ASSERT_GE(all.size(), 3u);
  // Times are whole microseconds: that of the ping's arrival, and of the answer's.
  EXPECT_NEAR(all[0].travel_time_s, 1200 / sound_mps, 1.1e-6);
  // The first ping is at the first sample, at 10 ms; an answer is received when its 10 ms are over, and reported at the
  // next sample.
  const double first_s = static_cast<double>(all[0].utime - test.world.epoch_us()) * 1e-6;
  const double received_s = 1200 / sound_mps + 0.05 + 0.01;
  EXPECT_NEAR(first_s, 0.01 + received_s + 0.005, 0.0051);
  // The next ping is sent when the answer is in: at the same sample.
  EXPECT_NEAR(static_cast<double>(all[1].utime - all[0].utime) * 1e-6, received_s + 0.005, 0.0051);
}

TEST(Usbl, BothMayMoveWhileTheSoundIsUnderWay) {
  test::TestWorld test(usbl_world("", transponder("t", "[750, 0, -10]", ", turnaround_s: 0.1"), "[]",
                                  "{water: {surface_m: 0, sound_speed_mps: 1500}}"));
  const double own_mps = 10, target_mps = -4;
  test::set_velocity(test, {own_mps, 0, 0});
  for (const auto& [name, body] : test.world.find_vehicle("t")->bodies())
    body->set_velocity_W({target_mps, 0, 0}, sim::Vector3d::Zero());
  test::Listener<usbl_t> truths(test, "r1.s.truth");
  test.run_for(1.3);
  const usbl_t fix = truths.last();
  // Along one line, at 1500 m/s.  The ping leaves after one step, 10 ms, and meets a target that comes to meet it; its
  // answer begins 0.1 s later, and meets a sensor that comes to meet it.
  const double at_ping_m = 750 + (target_mps - own_mps) * 0.01;
  const double out_s = at_ping_m / (1500 - target_mps);
  const double at_answer_m = at_ping_m + (target_mps - own_mps) * (out_s + 0.1);
  const double back_s = at_answer_m / (1500 + own_mps);
  EXPECT_NEAR(fix.travel_time_s, out_s + back_s, 1.1e-6);            // two times are whole microseconds
  EXPECT_NEAR(fix.range_m, 1500 * (out_s + back_s) / 2, 20 * 1e-6);  // in one the ends move by 10 and 4 um
  EXPECT_NEAR(fix.azimuth_rad, 0, 1e-9);
}

TEST(Usbl, ReportsTheDirectionInItsAxesWhenTheAnswerArrives) {
  test::TestWorld test(
      usbl_world("", transponder("t", "[300, 0, -10]"), "[]", "{water: {surface_m: 0, sound_speed_mps: 1500}}"));
  const double turn_radps = 1.5;
  for (const auto& [name, body] : test.world.find_vehicle("r1")->bodies())
    body->set_velocity_W(sim::Vector3d::Zero(), {0, 0, turn_radps});
  test::Listener<usbl_t> truths(test, "r1.s.truth");
  test.run_for(0.5);
  // Ping after 10 ms, 0.2 s there, 20 ms of turnaround, 0.2 s back; it turned continuously, with the error of the
  // integration of a turn in steps of 10 ms: (w dt)^2 / 12 of the angle.
  const double turned_rad = turn_radps * (0.01 + 0.2 + 0.02 + 0.2);
  EXPECT_NEAR(truths.last().azimuth_rad, -turned_rad, turned_rad * 2e-5 + 2e-6);
}

TEST(Usbl, AWrongSpeedOfSoundScalesTheRange) {
  test::TestWorld test(usbl_world(", assumed_sound_speed_mps: 1450", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(0.5);
  // 1 us is 0.7 mm.
  EXPECT_NEAR(fixes.last().range_m, 100 * 1450 / test.world.medium().sound_speed_mps({0, 0, -10}), 1e-3);
}

TEST(Usbl, AWallHidesWhatIsBehindItAndAnotherNetworkIsSilent) {
  const std::string wall =
      "[{name: wall, fixed: true, position_m: [20, 0, -10], parts: [{shape: box, size_m: [0.1, 2, 2]}]}]";
  const std::string others = transponder("behind", "[40, 0, -10]") + transponder("beside", "[0, 40, -10]") +
                             transponder("strange", "[0, -30, -10]", ", network: other");
  const auto targets = [&](const char* acoustics) {
    test::TestWorld test(usbl_world("", others, wall) + acoustics);
    test::Listener<usbl_t> fixes(test, "r1.s");
    test.run_for(0.5);
    std::vector<std::string> names;
    for (const auto& fix : fixes.take_all()) names.push_back(fix.target);
    return names;
  };
  EXPECT_THAT(targets(""), testing::ElementsAre("beside/t"));
  EXPECT_THAT(targets("acoustics: {occlusion: false}\n"), testing::UnorderedElementsAre("behind/t", "beside/t"));
}

TEST(Usbl, WorksUnderWaterOnly) {
  const std::string other = transponder("t", "[20, 0, -30]");
  test::TestWorld test(marine_world("type: usbl", "[0, 0, -10]", "[]", other, "{water: {surface_m: -20}}"));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(1.5);
  EXPECT_EQ(fixes.take_all().size(), 0u);
  EXPECT_THAT(test::error_of_world(marine_world("type: usbl", "[0, 0, -10]", "[]", other, "{}")),
              testing::HasSubstr("vehicle 'r1': device 's': a device of type 'usbl' needs water"));
}

TEST(Usbl, ErrorsHaveTheSpreadAskedFor) {
  test::TestWorld test(
      usbl_world(", ping_period_s: 0.01, range_noise: {gaussian_std: 0.5}, azimuth_noise: {gaussian_std: 0.01}",
                 transponder("t", "[1, 0, -10]", ", turnaround_s: 0")));
  test::Listener<usbl_t> fixes(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(40);
  std::vector<double> ranges, azimuths;
  // Far enough from zero that nothing is cut off: the range is compared as a share of those above it.
  for (const auto& fix : fixes.take_all()) {
    ranges.push_back(fix.range_m);
    azimuths.push_back(fix.azimuth_rad);
  }
  const auto in_azimuth = test::statistics(azimuths);
  ASSERT_GT(in_azimuth.count, 1000);
  EXPECT_NEAR(in_azimuth.std, 0.01, 4 * 0.01 / std::sqrt(2 * in_azimuth.count));
  double above = 0;
  for (const double range_m : ranges) above += range_m > 1.5 ? 1 : 0;  // one standard deviation: 15.87 %
  const double n = in_azimuth.count;
  EXPECT_NEAR(above / n, 0.1587, 4 * std::sqrt(0.1587 * 0.8413 / n));
  EXPECT_NEAR(truths.last().range_m, 1, 1e-9);
}

/// Standard deviations of the measured position in the axes of the sensor.
sim::Vector3d position_std_m(const std::string& keys, const std::string& position_m) {
  test::TestWorld test(usbl_world(", ping_period_s: 0.01" + keys, transponder("t", position_m, ", turnaround_s: 0")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(300);
  std::vector<double> of[3];
  for (const auto& fix : fixes.take_all())
    for (int i = 0; i < 3; ++i) of[i].push_back(fix.position_m[i]);
  EXPECT_GT(of[0].size(), 900u);
  return {test::statistics(of[0]).std, test::statistics(of[1]).std, test::statistics(of[2]).std};
}

TEST(Usbl, AboveItsTransponderItsErrorsAreTheSameInBothDirections) {
  const std::string keys = ", azimuth_noise: {gaussian_std: 0.01}, elevation_noise: {gaussian_std: 0.01}";
  // 200 m below, 2 m ahead and to the left; the standard deviation of some 1000 values is known to 2.3 %.
  const sim::Vector3d below = position_std_m(keys, "[0, 0, -210]");
  EXPECT_NEAR(below.x(), 2, 4 * 0.046);
  EXPECT_NEAR(below.y(), 2, 4 * 0.046);
  EXPECT_LT(below.z(), 0.05);
  // At an elevation of 60 degrees: across 2 m, along 2 m times its sine, up 2 m times its cosine.
  const sim::Vector3d aside = position_std_m(keys, "[0, 100, -183.205]");
  EXPECT_NEAR(aside.x(), 2, 4 * 0.046);
  EXPECT_NEAR(aside.y(), 2 * std::sqrt(3) / 2, 4 * 0.046);
  EXPECT_NEAR(aside.z(), 1, 4 * 0.023);
}

TEST(Usbl, APlanarArrayMeasuresTwoCosinesAndHardlyElevationsNearItsPlane) {
  // A difference of phase of 0.1 rad: with 28 kHz, 0.2 m and 1490 m/s 4.23e-3 of each cosine, 0.85 m at 200 m.  The
  // standard deviation of some 1000 values is known to 2.3 %.
  const std::string keys = ", array: {baseline_m: 0.2, phase_std_deg: 5.729578}";
  const double std_m = 200 * 1490 / 28000.0 / (2 * M_PI * 0.2) * 0.1;
  const sim::Vector3d below = position_std_m(keys, "[0, 0, -210]");
  EXPECT_NEAR(below.x(), std_m, 0.1 * std_m);
  EXPECT_NEAR(below.y(), std_m, 0.1 * std_m);
  // 30 degrees below the level: horizontally the same, and the height by the cotangent of that: sqrt(3) times as much.
  const sim::Vector3d aside = position_std_m(keys, "[173.205, 0, -110]");
  EXPECT_NEAR(aside.x(), std_m, 0.1 * std_m);
  EXPECT_NEAR(aside.y(), std_m, 0.1 * std_m);
  EXPECT_NEAR(aside.z(), std::sqrt(3) * std_m, 0.1 * std::sqrt(3) * std_m);
}

TEST(Usbl, TheErrorsOfAnArrayGrowAsTheSignalGetsWeaker) {
  // 20 dB less are ten times the error of a phase.  sqrt(n) for the deviation of 1000 values: 2.3 %.
  const auto across_m = [](int source_level_dB) {
    test::TestWorld test(usbl_world(
        ", ping_period_s: 0.01, array: {baseline_m: 0.1}",
        transponder("t", "[0, 0, -110]", ", turnaround_s: 0, source_level_dB: " + std::to_string(source_level_dB))));
    test::Listener<usbl_t> fixes(test, "r1.s");
    test.run_for(170);
    std::vector<double> y_m;
    for (const auto& fix : fixes.take_all()) y_m.push_back(fix.position_m[1]);
    EXPECT_GT(y_m.size(), 900u);
    return test::statistics(y_m).std;
  };
  EXPECT_NEAR(across_m(130) / across_m(150), 10, 4 * 0.33);
}

TEST(Usbl, TranspondersComeAndGoWithTheirVehicles) {
  test::TestWorld test(usbl_world(", ping_period_s: 0.1", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(0.5);
  EXPECT_GE(fixes.take_all().size(), 2u);
  test.world.editor().remove_vehicle("t");  // with an answer on its way
  test.run_for(0.3);
  fixes.take_all();
  test.run_for(0.5);
  EXPECT_EQ(fixes.take_all().size(), 0u);
}

TEST(Usbl, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(usbl_world(", range_max_m: 0", transponder("t", "[1, 0, 0]", ", turnaround_s: -1"))),
              testing::AllOf(testing::HasSubstr("'range_max_m' must be > 0"),
                             testing::HasSubstr("'turnaround_s' must be >= 0 and <= 10, got -1")));
}

}  // namespace
