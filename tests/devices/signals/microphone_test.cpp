// SPDX-License-Identifier: BSD-3-Clause
#include "devices/signals/microphone.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/sound_t.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using testing::HasSubstr;

/// A box at the origin with a microphone, and boxes with speakers of 80 dB at 1 m: `far` at (0, 10, 0), `near` at
/// (3, 0, 4).  All bark from 0.1 s on for 1 s.
std::string world_of_sounds(const std::string& keys = "", const std::string& barking = "[far]") {
  const auto box = [](const std::string& name, const std::string& at, const std::string& device) {
    return "  - name: " + name + "\n    position_m: " + at + R"(
    model:
      shoal: 1
      vehicle: box
      bodies: [{name: hull, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}]
      devices:
        - {)" +
           device + "}\n";
  };
  const std::string speaker = "name: speaker, type: speaker, sounds: [{name: NAME, duration_s: 1, level_dB: 80}]";
  const auto named = [&](const std::string& name) {
    return std::string(speaker).replace(speaker.find("NAME"), 4, name);
  };
  std::string text = "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nvehicles:\n" +
                     box("r1", "[0, 0, 0]", "name: ear, type: microphone" + keys) +
                     box("far", "[0, 10, 0]", named("howl")) + box("near", "[3, 0, 4]", named("bark")) +
                     "events:\n  - name: on\n    at: 0.1\n    do:\n";
  for (const auto& [name, sound] : {std::pair("far", "howl"), std::pair("near", "bark")})
    if (barking.find(name) != std::string::npos)
      text += std::string("      - {publish: {channel: ") + name +
              ".speaker.cmd, type: shoal.sound_t, value: {sound: " + sound + ", volume: 1}}}\n";
  return text;
}

TEST(Microphone, LosesTwentyDecibelForTenTimesTheDistance) {
  test::TestWorld test(world_of_sounds(", ambient_dB: 0"));
  test::Listener<shoal::sound_t> reports(test, "r1.ear");
  test.run_for(0.5);
  const auto report = reports.last();
  EXPECT_EQ(report.sound, "howl");
  EXPECT_NEAR(report.level_dB, 60, 1e-5);  // the ambient noise of 0 dB adds 4e-6 dB
  EXPECT_NEAR(report.bearing_rad, std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(report.elevation_rad, 0, 1e-9);
}

TEST(Microphone, AddsPowersAndPointsToTheLoudest) {
  test::TestWorld test(world_of_sounds(", ambient_dB: 0, rpy_deg: [0, 0, 90]", "[far, near]"));
  test::Listener<shoal::sound_t> reports(test, "r1.ear");
  test.run_for(0.5);
  const auto report = reports.last();
  EXPECT_EQ(report.sound, "bark");
  // 80 dB at 5 m and at 10 m: 1/25 + 1/100 of the power at 1 m.
  EXPECT_NEAR(report.level_dB, 80 + 10 * std::log10(0.05), 1e-5);
  EXPECT_NEAR(report.bearing_rad, -std::numbers::pi / 2, 1e-9);  // its x is the y of the box
  EXPECT_NEAR(report.elevation_rad, std::atan2(4, 3), 1e-9);
}

TEST(Microphone, AngleErrorsStayWithinOneTurn) {
  test::TestWorld test(world_of_sounds(", ambient_dB: 0, rpy_deg: [0, 0, -89], bearing_noise: {bias: 0.1}"));
  test::Listener<shoal::sound_t> reports(test, "r1.ear");
  test.run_for(0.5);
  // The sound is at 179 degrees; 0.1 rad more are behind the sensor, at the other side.
  EXPECT_NEAR(reports.last().bearing_rad, 179 * std::numbers::pi / 180 + 0.1 - 2 * std::numbers::pi, 1e-9);
}

TEST(Microphone, ReportsNothingBelowTheAmbientNoiseAndOnceThatASoundHasEnded) {
  test::TestWorld deaf(world_of_sounds(", ambient_dB: 60.1"));
  test::Listener<shoal::sound_t> nothing(deaf, "r1.ear");
  deaf.run_for(2);
  EXPECT_TRUE(nothing.take_all().empty());
  test::TestWorld test(world_of_sounds(", ambient_dB: 50, rate_hz: 10"));
  test::Listener<shoal::sound_t> reports(test, "r1.ear");
  test.run_for(2);
  const auto all = reports.take_all();
  ASSERT_GE(all.size(), 10u);  // 1 s of sound at 10 Hz, and the end
  EXPECT_LE(all.size(), 12u);
  EXPECT_EQ(all.back().sound, "");
  EXPECT_NEAR(all.back().level_dB, 50, 1e-9);
}

TEST(Microphone, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(world_of_sounds(", ambient_dB: 0, rate_hz: 100, level_noise: {gaussian_std: 2}"));
  test::Listener<shoal::sound_t> reports(test, "r1.ear");
  test.run_for(1);
  double squares = 0;
  int count = 0;
  for (const shoal::sound_t& report : reports.take_all()) squares += std::pow(report.level_dB - 60, 2), ++count;
  ASSERT_GT(count, 80);
  EXPECT_NEAR(std::sqrt(squares / count), 2, 4 * 2 / std::sqrt(2.0 * count));  // four deviations of the estimate
}

TEST(Microphone, ContinuesAlikeFromASnapshot) {
  test::SavedRun run(world_of_sounds(", level_noise: {gauss_markov_std: 1}", "[far, near]"));
  run.expect_restored_worlds_go_on_alike({0, 15, 60}, 150);
}

TEST(Microphone, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(world_of_sounds(", ambient_dB: 200")),
              HasSubstr("'ambient_dB' must be >= -20 and <= 194, got 200"));
}

}  // namespace
