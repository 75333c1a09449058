// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "devices/sound_positioning/usbl_array.hpp"
#include "shoal/transponder_t.hpp"
#include "shoal/usbl_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::usbl_t;
using test::marine_world;

std::string transponder(const std::string& name, const std::string& position_m, const std::string& more = "") {
  return "  - {name: " + name + ", position_m: " + position_m +
         ", model: {shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, "
         "size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [{name: t, type: transponder, rate_hz: 10" +
         more + "}]}}\n";
}
std::string usbl_world(const std::string& keys, const std::string& others, const std::string& objects = "[]",
                       const std::string& medium = "{water: {surface_m: 0}}") {
  return marine_world("type: usbl" + keys, "[0, 0, -10]", objects, others, medium);
}

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

std::vector<std::string> first_targets(const std::string& yaml, double within_s = 0.5) {
  test::TestWorld test(yaml);
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(within_s);
  std::vector<std::string> names;
  for (const auto& fix : fixes.take_all()) names.push_back(fix.target);
  return names;
}

TEST(Transponder, SeveralAnswerAtATimeUnlessTheyShareABand) {
  const auto ring = [](const std::string& more) {
    return transponder("e", "[100, 0, -10]", more) + transponder("n", "[0, 100, -10]", more) +
           transponder("w", "[-100, 0, -10]", more) + transponder("s", "[0, -100, -10]", more);
  };
  EXPECT_THAT(first_targets(usbl_world("", ring(""))), testing::UnorderedElementsAre("e/t", "n/t", "w/t", "s/t"));
  // All answers come at once: the receiver takes one.
  EXPECT_EQ(first_targets(usbl_world("", ring(", answer_frequency_Hz: 30000"))).size(), 1u);
}

TEST(Transponder, ReceivesPingsOnItsFrequencyThatAreLoudEnough) {
  const auto received = [](const std::string& keys, const std::string& more) {
    return !first_targets(usbl_world(keys, transponder("t", "[100, 0, -10]", more))).empty();
  };
  EXPECT_TRUE(received(", frequency_Hz: 20000", ", frequency_Hz: 20000"));
  EXPECT_FALSE(received(", frequency_Hz: 20000", ""));
  EXPECT_FALSE(received("", ", code: A, network: lbl"));
  // 100 m take 15 log10(100) = 30 dB and 0.6 dB; the noise at 26 kHz in 1 kHz is some 60 dB, and 6 dB are needed.
  EXPECT_FALSE(received(", source_level_dB: 80", ""));
  EXPECT_FALSE(received("", ", source_level_dB: 80"));
  EXPECT_TRUE(received(", source_level_dB: 120", ", source_level_dB: 120"));
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

TEST(UsblArray, HasTheErrorOfTwoPhasesInNoise) {
  devices::UsblArrayParams array;
  array.baseline_m = 0.2;
  // 20 dB and 10 independent samples: phases of 1 / sqrt(2 * 1000) rad each, sqrt(2) times that for their difference.
  EXPECT_NEAR(array.cosine_std({sim::PowerRatio(100), 10, 0.05}),
              0.05 / (2 * M_PI * 0.2) * std::sqrt(1 / 1000.0 * (1 + 1 / 200.0)), 1e-12);
  array.phase_std_rad = 0.3;
  EXPECT_NEAR(array.cosine_std({sim::PowerRatio(1e12), 10, 0.05}), 0.05 / (2 * M_PI * 0.2) * 0.3, 1e-9);
}

TEST(UsblArray, DirectionsTurnAsOnASphere) {
  const sim::Vector3d level = devices::turned(0.3, 0, 0.1, 0);
  EXPECT_NEAR(std::atan2(level.y(), level.x()), 0.4, 1e-12);
  EXPECT_NEAR(level.z(), 0, 1e-12);
  const sim::Vector3d below = devices::turned(0, -M_PI / 2, 0.1, 0);
  EXPECT_NEAR((below - sim::Vector3d(0, std::sin(0.1), -std::cos(0.1))).norm(), 0, 1e-12);
  EXPECT_NEAR(devices::turned(1, -1, 0.2, 0.3).norm(), 1, 1e-12);
  // Beyond the plane of the array: in it.  The side is known.
  EXPECT_EQ(devices::with_cosine_errors({1, 0, 0}, 0.01, 0), sim::Vector3d(1, 0, 0));
  EXPECT_NEAR(devices::with_cosine_errors({0, 0, -1}, 0.6, 0).z(), -0.8, 1e-12);
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

TEST(Transponder, ASilentOneDoesNotAnswer) {
  // It waits for answers from as far as its range, 0.2 s.
  test::TestWorld test(usbl_world(", ping_period_s: 0.1, range_max_m: 120", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.world.editor().set_fault("t/t", {});  // silent
  test.run_for(0.5);
  EXPECT_EQ(fixes.take_all().size(), 0u);
  test.world.editor().clear_faults("t/t");
  test.run_for(0.5);
  EXPECT_GE(fixes.take_all().size(), 2u);
}

TEST(Usbl, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(usbl_world(", range_max_m: 0", transponder("t", "[1, 0, 0]", ", turnaround_s: -1"))),
              testing::AllOf(testing::HasSubstr("'range_max_m' must be > 0"),
                             testing::HasSubstr("'turnaround_s' must be >= 0 and <= 10, got -1")));
}

}  // namespace
