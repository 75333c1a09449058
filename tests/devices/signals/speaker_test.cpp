// SPDX-License-Identifier: BSD-3-Clause
#include "devices/signals/speaker.hpp"

#include <gmock/gmock.h>

#include "shoal/sound_t.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using testing::HasSubstr;

std::string speaker_world(const std::string& more = "") {
  return test::box_world(
      "        - {name: speaker, type: speaker, sounds: [{name: bark, duration_s: 0.3, level_dB: 80}, {name: beep}]}\n",
      "{step_s: 0.01, gravity_mps2: 0}", more);
}

shoal::sound_t command(const std::string& sound, double volume = 1) {
  shoal::sound_t message{};
  message.sound = sound;
  message.volume = volume;
  return message;
}

TEST(Speaker, SaysWhatItPlaysUntilWhenAndThatItHasEnded) {
  test::TestWorld test(speaker_world());
  test::Listener<shoal::sound_t> reports(test, "r1.speaker");
  test.run_for(0.1);
  test.send("r1.speaker.cmd", command("bark", 0.1));
  test.run_for(0.5);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].sound, "bark");
  EXPECT_NEAR(all[0].level_dB, 60, 1e-9);  // a tenth of the pressure: 20 dB less
  EXPECT_NEAR(static_cast<double>(all[0].until_utime - all[0].utime) * 1e-6, 0.3, 0.03);  // two samples of 20 ms
  EXPECT_EQ(all[1].sound, "");
  EXPECT_NEAR(static_cast<double>(all[1].utime - all[0].until_utime) * 1e-6, 0, 0.03);
}

TEST(Speaker, StopsByACommandWithoutASound) {
  test::TestWorld test(speaker_world());
  test::Listener<shoal::sound_t> reports(test, "r1.speaker");
  test.send("r1.speaker.cmd", command("beep"));
  test.run_for(0.1);
  test.send("r1.speaker.cmd", command("", 0));
  test.run_for(0.1);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].sound, "");
  EXPECT_LT(all[1].utime - all[0].utime, 150000);
}

TEST(Speaker, ContinuesAlikeFromASnapshot) {
  test::SavedRun run(speaker_world(R"(events:
  - {name: bark, at: 0.2, do: [{publish: {channel: r1.speaker.cmd, type: shoal.sound_t, value: {sound: bark, volume: 1}}}]}
)"));
  run.expect_restored_worlds_go_on_alike({0, 25, 40}, 100);
}

TEST(Speaker, IgnoresBadCommandsAndContinues) {
  test::TestWorld test(speaker_world());
  test::Listener<shoal::sound_t> reports(test, "r1.speaker");
  test.send("r1.speaker.cmd", command("brak"));
  test.send("r1.speaker.cmd", command("bark", 0));
  test.send("r1.speaker.cmd", command("bark", 1.1));
  test.run_for(0.1);
  EXPECT_EQ(test.world.counts().bad_messages, 3);
  EXPECT_TRUE(reports.take_all().empty());
}

TEST(Speaker, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) {
    return test::error_of_world(test::box_world("        - {name: speaker, type: speaker" + keys + "}\n"));
  };
  EXPECT_THAT(error(""), HasSubstr("missing key 'sounds'"));
  EXPECT_THAT(error(", sounds: [{name: a}, {name: a}]"), HasSubstr("'sounds' names 'a' twice"));
  EXPECT_THAT(error(", sounds: [{name: a, duration_s: 0}]"), HasSubstr("'duration_s' must be >= 0.001"));
}

}  // namespace
