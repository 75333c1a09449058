#include <gmock/gmock.h>

#include "shoal/transponder_t.hpp"
#include "shoal/usbl_t.hpp"
#include "tests/devices/immersed_sensor_fixture.hpp"

namespace {

using shoal::usbl_t;
using test::marine_world;

std::string transponder(const std::string& name, const std::string& position_m, const std::string& more = "") {
  return "  - {name: " + name + ", position_m: " + position_m +
         ", model: {shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, "
         "size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [{name: t, type: transponder, rate_hz: 10" +
         more + "}]}}\n";
}
std::string usbl_world(const std::string& keys, const std::string& others, const std::string& objects = "[]") {
  return marine_world("type: usbl" + keys, "[0, 0, -10]", objects, others);
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
  EXPECT_NEAR(all[0].travel_time_s, 1200 / sound_mps, 1e-9);
  // The first ping is at the first sample, at 0 or 10 ms.
  const double first_s = static_cast<double>(all[0].utime - test.world.epoch_us()) * 1e-6;
  EXPECT_NEAR(first_s, 1200 / sound_mps + 0.05 + 0.01, 0.0151);
  // The next ping is sent when the answer is in: at the same sample.
  EXPECT_NEAR(static_cast<double>(all[1].utime - all[0].utime) * 1e-6, 1200 / sound_mps + 0.05, 0.0101);
}

TEST(Usbl, AMovingOneMeasuresTheMeanOfBothWays) {
  test::TestWorld test(usbl_world("", transponder("t", "[750, 0, -10]")));
  test::set_velocity(test, {10, 0, 0});
  test::Listener<usbl_t> fixes(test, "r1.s.truth");
  double pinged_m = 0, heard_m = 0;
  test.run_for(0.01);
  pinged_m = test.world.find_vehicle("r1")->X_WV().translation().x();
  std::vector<usbl_t> heard;
  while (heard.empty()) {
    test.run_for(0.01);
    heard = fixes.take_all();
    heard_m = test.world.find_vehicle("r1")->X_WV().translation().x();
  }
  ASSERT_GT(heard_m - pinged_m, 9);                                      // a second of sound
  EXPECT_NEAR(heard[0].range_m, 750 - (pinged_m + heard_m) / 2, 0.051);  // a sample of 10 ms is 0.1 m
}

TEST(Usbl, AWrongSpeedOfSoundScalesTheRange) {
  test::TestWorld test(usbl_world(", assumed_sound_speed_mps: 1450", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(0.5);
  EXPECT_NEAR(fixes.last().range_m, 100 * 1450 / test.world.medium().sound_speed_mps({0, 0, -10}), 1e-6);
}

TEST(Usbl, AWallHidesWhatIsBehindItAndAnotherNetworkIsSilent) {
  const std::string wall =
      "[{name: wall, fixed: true, position_m: [20, 0, -10], parts: [{shape: box, size_m: [0.1, 2, 2]}]}]";
  const std::string others = transponder("behind", "[40, 0, -10]") + transponder("beside", "[0, 40, -10]") +
                             transponder("strange", "[0, -30, -10]", ", network: other");
  const auto targets = [&](const char* keys) {
    test::TestWorld test(usbl_world(keys, others, wall));
    test::Listener<usbl_t> fixes(test, "r1.s");
    test.run_for(0.5);
    std::vector<std::string> names;
    for (const auto& fix : fixes.take_all()) names.push_back(fix.target);
    return names;
  };
  EXPECT_THAT(targets(""), testing::ElementsAre("beside/t"));
  EXPECT_THAT(targets(", occlusion: false"), testing::ElementsAre("behind/t", "beside/t"));
}

TEST(Usbl, WorksUnderWaterOnly) {
  for (const char* medium : {"{water: {surface_m: -20}}", "{}"}) {
    test::TestWorld test(marine_world("type: usbl", "[0, 0, -10]", "[]", transponder("t", "[20, 0, -30]"), medium));
    test::Listener<usbl_t> fixes(test, "r1.s");
    test.run_for(1.5);
    EXPECT_EQ(fixes.take_all().size(), 0u) << medium;
  }
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

TEST(Usbl, TranspondersComeAndGoWithTheirVehicles) {
  test::TestWorld test(usbl_world(", ping_period_s: 0.1", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(0.5);
  EXPECT_GE(fixes.take_all().size(), 2u);
  test.world.remove_vehicle("t");  // with an answer on its way
  test.run_for(0.3);
  fixes.take_all();
  test.run_for(0.5);
  EXPECT_EQ(fixes.take_all().size(), 0u);
}

TEST(Transponder, ASilentOneDoesNotAnswer) {
  test::TestWorld test(usbl_world(", ping_period_s: 0.1", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.world.set_fault("t/t", {});  // silent
  test.run_for(0.5);
  EXPECT_EQ(fixes.take_all().size(), 0u);
  test.world.clear_faults("t/t");
  test.run_for(0.5);
  EXPECT_GE(fixes.take_all().size(), 2u);
}

TEST(Usbl, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(usbl_world(", range_max_m: 0", transponder("t", "[1, 0, 0]", ", turnaround_s: -1"))),
              testing::AllOf(testing::HasSubstr("'range_max_m' must be > 0"),
                             testing::HasSubstr("'turnaround_s' must be >= 0 and <= 10, got -1")));
}

}  // namespace
