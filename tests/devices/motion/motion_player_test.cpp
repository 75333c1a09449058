// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/motion_player.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "shoal/joint_servo_command_t.hpp"
#include "shoal/motion_command_t.hpp"
#include "shoal/motion_state_t.hpp"
#include "shoal/sound_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;
using Phase = devices::MotionPlayer::Phase;
constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

const char* const ramp = R"(shoal: 1
motion: ramp
angles: rad
start: {max_velocity: 1, min_s: 0.1}
keys:
  - {at_s: 0, joints: {hip: 0, knee: 0.4}}
  - {at_s: 0.8, joints: {hip: 0.8, knee: 0.4}}
)";
const char* const circle = R"(shoal: 1
motion: circle
angles: rad
loop: true
keys:
  - {at_s: 0, joints: {maker/knee: 0}}
  - {at_s: 0.2, joints: {maker/knee: 0.2}}
  - {at_s: 0.4, joints: {maker/knee: 0}}
)";

struct Stage {
  test_support::ScratchFolder folder;

  Stage() {
    std::ofstream(folder.file("ramp.yaml")) << ramp;
    std::ofstream(folder.file("circle.yaml")) << circle;
  }
  std::string world(const std::string& more = "") const {
    return test::leg_world(
        "        - {name: group, type: joint_group}\n        - {name: player, type: motion_player, group: "
        "group, motions: [{file: " +
        folder.file("ramp.yaml") + "}, {file: " + folder.file("circle.yaml") + "}]" + more + "}\n");
  }
};

shoal::motion_command_t command(int number, const std::string& motion = "", double from_s = not_given,
                                double to_s = not_given, double rate = not_given) {
  shoal::motion_command_t message{};
  message.command = static_cast<std::int8_t>(number);
  message.motion = motion;
  message.from_s = from_s;
  message.to_s = to_s;
  message.rate = rate;
  return message;
}

const devices::MotionPlayer& player_of(test::LoadedTestWorld& test) {
  return dynamic_cast<const devices::MotionPlayer&>(*test.world.find_vehicle("dog")->find_device("player")->sensor());
}

std::span<const double> commanded(test::LoadedTestWorld& test) {
  auto* sensor = test.world.find_vehicle("dog")->find_device("group")->sensor();
  return const_cast<devices::JointGroup&>(dynamic_cast<const devices::JointGroup&>(*sensor)).commanded();
}

TEST(MotionPlayer, ApproachesTheFirstValuesSoftlyThenPlaysOnTheBeat) {
  const Stage stage;
  test::TestWorld test(stage.world());
  test.send("dog.player.cmd", command(0, "ramp"));
  // The knee is 0.4 rad away: a smooth way with at most 1 rad/s takes 1.5 * 0.4 / 1 = 0.6 s.
  test.run_for(0.3);
  EXPECT_EQ(player_of(test).phase(), Phase::approach);
  EXPECT_NEAR(player_of(test).at_s(), -0.3, 1e-9);
  EXPECT_NEAR(commanded(test)[1], 0.2, 1e-9);  // half way at half time
  test.run_for(0.3);
  EXPECT_NEAR(commanded(test)[1], 0.4, 1e-9);
  EXPECT_NEAR(commanded(test)[0], 0, 1e-9);
  test.run_for(0.4);
  EXPECT_EQ(player_of(test).phase(), Phase::playing);
  EXPECT_NEAR(player_of(test).at_s(), 0.4, 1e-9);
  EXPECT_NEAR(commanded(test)[0], 0.4, 1e-9);
  test.run_for(0.5);
  EXPECT_EQ(player_of(test).phase(), Phase::idle);
  EXPECT_EQ(player_of(test).finished(), 1);
  EXPECT_NEAR(commanded(test)[0], 0.8, 1e-12);
}

TEST(MotionPlayer, ApproachesFromWhereAnotherHasMovedTheServos) {
  const Stage stage;
  test::TestWorld test(stage.world());
  test.send("dog.player.cmd", command(0, "ramp"));
  test.run_for(2);
  shoal::joint_servo_command_t other{};
  other.position = -0.5;
  test.send("dog.hip.cmd", other);
  test.run_for(1);
  test.send("dog.player.cmd", command(0, "ramp"));
  test.run_for(0.004);
  EXPECT_NEAR(commanded(test)[0], -0.5, 1e-3);  // the soft start of 0.5 rad in 0.75 s: 3 (0.004 / 0.75)^2 of it
}

TEST(MotionPlayer, PlaysAPartAtAnotherRate) {
  const Stage stage;
  test::TestWorld test(stage.world());
  auto play = command(0, "ramp", 0.2, 0.6, 0.5);
  play.skip_approach = 1;
  test.send("dog.player.cmd", play);
  test.run_for(0.4);
  EXPECT_NEAR(commanded(test)[0], 0.4, 1e-9);  // 0.2 + 0.5 * 0.4
  test.run_for(0.6);
  EXPECT_NEAR(commanded(test)[0], 0.6, 1e-12);
  EXPECT_EQ(player_of(test).phase(), Phase::idle);
}

TEST(MotionPlayer, ALoopHasThePeriodOfItsMotion) {
  const Stage stage;
  test::TestWorld test(stage.world());
  auto play = command(0, "circle");
  play.skip_approach = 1;
  test.send("dog.player.cmd", play);
  test.run_for(0.1);
  for (int turn = 0; turn < 50; ++turn) {
    EXPECT_NEAR(commanded(test)[1], 0.1, 1e-9) << turn;
    test.run_for(0.4);
  }
  play.repeat = 3;
  test.send("dog.player.cmd", play);
  test.run_for(1.19);
  EXPECT_EQ(player_of(test).phase(), Phase::playing);
  test.run_for(0.02);
  EXPECT_EQ(player_of(test).phase(), Phase::idle);
}

TEST(MotionPlayer, PausesResumesAndSeeks) {
  const Stage stage;
  test::TestWorld test(stage.world());
  auto play = command(0, "ramp");
  play.skip_approach = 1;
  test.send("dog.player.cmd", play);
  test.run_for(0.2);
  test.send("dog.player.cmd", command(2));
  test.run_for(5);
  EXPECT_NEAR(commanded(test)[0], 0.2, 1e-9);
  EXPECT_EQ(player_of(test).phase(), Phase::paused);
  test.send("dog.player.cmd", command(4, "", 0.7));
  test.send("dog.player.cmd", command(3));
  test.run_for(0.05);
  EXPECT_NEAR(commanded(test)[0], 0.75, 1e-9);
  test.send("dog.player.cmd", command(1));
  test.run_for(1);
  EXPECT_NEAR(commanded(test)[0], 0.75, 1e-9);
  EXPECT_EQ(player_of(test).phase(), Phase::idle);
}

TEST(MotionPlayer, PlaysFromTheStartWhenItsFileSaysSo) {
  const Stage stage;
  test::TestWorld test(stage.world(", play: {motion: circle}"));
  test.run_for(1);
  EXPECT_EQ(player_of(test).phase(), Phase::playing);
}

TEST(MotionPlayer, ReportsItsPlayhead) {
  const Stage stage;
  test::TestWorld test(stage.world());
  test::Listener<shoal::motion_state_t> reports(test, "dog.player");
  test.send("dog.player.cmd", command(0, "ramp"));
  test.run_for(1);
  const shoal::motion_state_t last = reports.last();
  EXPECT_EQ(last.motion, "ramp");
  EXPECT_EQ(last.phase, 2);
  EXPECT_GT(last.at_s, 0.25);
  EXPECT_EQ(last.to_s, 0.8);
}

TEST(MotionPlayer, IgnoresBadCommandsAndContinues) {
  const Stage stage;
  test::TestWorld test(stage.world());
  for (const auto& bad :
       {command(0, "rump"), command(0, "ramp", 0.5, 0.4), command(0, "ramp", 0, 9), command(0, "ramp", 0, 0.1, 0),
        command(4), command(7), command(0, "ramp", std::numeric_limits<double>::infinity())})
    test.send("dog.player.cmd", bad);
  test.run_for(0.2);
  EXPECT_EQ(player_of(test).phase(), Phase::idle);
}

TEST(MotionPlayer, SaysWhatIsWrongWithItsParameters) {
  const Stage stage;
  std::ofstream(stage.folder.file("bad.yaml")) << "shoal: 1\nmotion: bad\nkeys: [{at_s: 0, joints: {tail: 1}}]\n";
  std::ofstream(stage.folder.file("worse.yaml")) << "shoal: 1\nmotion: worse\nkeys: [{at_s: x, joints: {hip: 1}}]\n";
  const auto error = [](const std::string& keys) {
    return test::error_of_world(
        test::leg_world("        - {name: group, type: joint_group}\n        - {name: player, "
                        "type: motion_player, " +
                        keys + "}\n"));
  };
  EXPECT_THAT(error("group: hip"), HasSubstr("'group' must be a joint_group that is listed before this device"));
  EXPECT_THAT(error("group: group, play: {motion: ramp}"), HasSubstr("there is no motion 'ramp'"));
  EXPECT_THAT(error("group: group, motions: [{file: " + stage.folder.file("bad.yaml") + "}]"),
              HasSubstr("motion 'bad' names joint 'tail', which is not a servo of the group"));
  EXPECT_THAT(error("group: group, motions: [{file: " + stage.folder.file("worse.yaml") + "}]"),
              HasSubstr("worse.yaml:3:15: key 1: 'at_s' must be a number"));
  EXPECT_THAT(error("group: group, motions: [{file: none.yaml}]"), HasSubstr("none.yaml"));
}

/// A player of a motion of 0.4 s, whose lamp goes from 0 to 1, and which barks at its start, in its middle and at its
/// end.
std::string lit_world(const std::string& more = "") {
  return test::leg_world(
             "        - {name: led, type: led, lights: [{name: lamp}]}\n"
             "        - {name: speaker, type: speaker, rate_hz: every_step, sounds: [{name: bark, duration_s: 0.01}]}\n"
             "        - {name: group, type: joint_group}\n"
             "        - {name: player, type: motion_player, group: group, motions: [{motion: lit, lights: [lamp], "
             "keys: "
             "[{at_s: 0, joints: {hip: 0, lamp: 0}}, {at_s: 0.4, joints: {lamp: 1}}], sounds: [{at_s: 0, sound: bark}, "
             "{at_s: 0.2, sound: bark, volume: 0.5}, {at_s: 0.4, sound: bark}]}]}\n") +
         more;
}

TEST(MotionPlayer, PlaysLightsAndSounds) {
  test::TestWorld test(lit_world());
  test::Listener<shoal::sound_t> sounds(test, "dog.speaker");
  auto play = command(0, "lit");
  play.skip_approach = 1;
  test.send("dog.player.cmd", play);
  test.run_for(0.1);
  const auto& led = dynamic_cast<const devices::Led&>(*test.world.find_vehicle("dog")->find_device("led")->sensor());
  EXPECT_NEAR(led.intensities()[0], 0.25, 1e-9);
  test.run_for(0.5);
  EXPECT_EQ(led.intensities()[0], 1) << "it stays as the motion ended";
  std::vector<double> volumes;
  std::int64_t first = 0;
  for (const shoal::sound_t& sound : sounds.take_all()) {
    if (sound.sound.empty()) continue;
    if (volumes.empty()) first = sound.utime;
    // Half-way at 0.2 s, the end at 0.4 s, each within a step of 2 ms.
    EXPECT_NEAR(static_cast<double>(sound.utime - first) * 1e-6, 0.2 * static_cast<double>(volumes.size()), 0.0021);
    volumes.push_back(sound.volume);
  }
  EXPECT_THAT(volumes, testing::ElementsAre(1, 0.5, 1));
}

TEST(MotionPlayer, EachCycleOfALoopHasItsSounds) {
  test::TestWorld test(lit_world());
  test::Listener<shoal::sound_t> sounds(test, "dog.speaker");
  auto play = command(0, "lit", 0, 0.3);
  play.skip_approach = 1;
  play.repeat = 4;
  test.send("dog.player.cmd", play);
  test.run_for(2);
  int started = 0;
  for (const shoal::sound_t& sound : sounds.take_all()) started += sound.sound.empty() ? 0 : 1;
  EXPECT_EQ(started, 8);  // at 0 and 0.2 s of each cycle
}

TEST(MotionPlayer, NeedsTheLightsAndSoundsOfItsMotions) {
  const auto error = [](const std::string& motion) {
    return test::error_of_world(test::leg_world(
        "        - {name: led, type: led, lights: [{name: lamp}]}\n        - {name: group, type: joint_group}\n"
        "        - {name: player, type: motion_player, group: group, motions: [{motion: m, " +
        motion + "}]}\n"));
  };
  EXPECT_THAT(error("lights: [lmap], keys: [{at_s: 0, joints: {hip: 0, lmap: 1}}]"),
              HasSubstr("motion 'm' names light 'lmap', which the vehicle does not have; did you mean 'lamp'?"));
  EXPECT_THAT(error("keys: [{at_s: 0, joints: {hip: 0}}], sounds: [{at_s: 0, sound: bark}]"),
              HasSubstr("motion 'm' names sound 'bark', which the vehicle does not have"));
}

TEST(MotionPlayer, ContinuesWithLightsAndSoundsFromASnapshot) {
  test::SavedRun run(lit_world(), [](test::TappedWorld& world, int step) {
    if (step == 10) world.send("dog.player.cmd", command(0, "lit"));
  });
  run.expect_restored_worlds_go_on_alike({5, 60, 115}, 200);
}

TEST(MotionPlayer, ContinuesWithItsPlayheadFromASnapshot) {
  const Stage stage;
  test::SavedRun run(stage.world(), [](test::TappedWorld& world, int step) {
    if (step == 10) world.send("dog.player.cmd", command(0, "ramp"));
    if (step == 400) world.send("dog.player.cmd", command(0, "circle"));
    if (step == 500) world.send("dog.player.cmd", command(2));
    if (step == 520) world.send("dog.player.cmd", command(3));
  });
  run.expect_restored_worlds_go_on_alike({5, 100, 350, 450, 510, 600}, 150);
}

}  // namespace
