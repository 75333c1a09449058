// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "tests/sim/motion/motion_fixture.hpp"

namespace {

using namespace motion_fixture;

using testing::HasSubstr;

constexpr double deg = std::numbers::pi / 180;

TEST(JointMotion, ItsKeysSetAPoseAndSingleJoints) {
  const sim::JointMotion motion = MotionFile(wave).load();
  EXPECT_EQ(motion.name, "wave");
  EXPECT_EQ(motion.end_s(), 1);
  const auto tracks = motion.tracks();
  ASSERT_EQ(tracks.size(), 3u);
  EXPECT_EQ(tracks[0].joint, "lf_knee");
  ASSERT_EQ(tracks[0].keys.size(), 3u);
  EXPECT_NEAR(tracks[0].keys[1].value, 80 * deg, 1e-15);
  EXPECT_EQ(tracks[0].keys[1].ease, sim::Easing::linear);
  EXPECT_EQ(tracks[0].keys[2].ease, sim::Easing::cosine);
  // A joint that a key does not name continues from the key before to the one after.
  ASSERT_EQ(tracks[1].keys.size(), 2u);
  EXPECT_NEAR(tracks[1].value_at(0.5), 35 * deg, 1e-15);
  EXPECT_NEAR(tracks[2].value_at(0.3), -5 * deg, 1e-15);
}

TEST(JointMotion, ValuesOfSlidersAreNotAngles) {
  const sim::JointMotion motion =
      MotionFile("shoal: 1\nmotion: m\nsliders: [lift]\nkeys: [{at_s: 0, joints: {lift: 0.2, hip: 90}}]\n").load();
  EXPECT_EQ(motion.keys[0].joints[0].second, 0.2);
  EXPECT_NEAR(motion.keys[0].joints[1].second, 90 * deg, 1e-15);
}

TEST(JointMotion, ValuesOfLightsAreIntensities) {
  const char* const text = R"(shoal: 1
motion: m
lights: [face]
keys:
  - {at_s: 0, joints: {face: 0, hip: 90}}
  - {at_s: 1, joints: {face: 1}}
sounds:
  - {at_s: 0.25, sound: bark}
  - {at_s: 1, sound: whine, volume: 0.5}
)";
  const sim::JointMotion motion = MotionFile(text).load();
  EXPECT_EQ(motion.tracks()[0].value_at(0.5), 0.5);
  ASSERT_EQ(motion.sounds.size(), 2u);
  EXPECT_EQ(motion.sounds[0].volume, 1);
  EXPECT_EQ(motion.sounds[1].sound, "whine");
  const sim::JointMotion again = MotionFile(sim::motion_text(motion)).load();
  EXPECT_EQ(sim::motion_text(again), sim::motion_text(motion));
  EXPECT_EQ(again.lights, motion.lights);
  EXPECT_EQ(again.sounds[1].volume, 0.5);
}

TEST(JointMotion, SaysWhatIsWrongWithASound) {
  const auto error = [](const std::string& sound) {
    return MotionFile("shoal: 1\nmotion: m\nkeys: [{at_s: 0, joints: {hip: 1}}]\nsounds: [" + sound + "]\n").error();
  };
  EXPECT_THAT(error("{at_s: 0}"), HasSubstr("FILE:4:10: sound 1: missing key 'sound'"));
  EXPECT_THAT(error("{at_s: -1, sound: bark}"), HasSubstr("'at_s' must be >= 0"));
  EXPECT_THAT(error("{at_s: 0, sound: bark, volume: 2}"), HasSubstr("'volume' must be >= 1e-06 and <= 1, got 2"));
}

TEST(JointMotion, ReadsItsFramesFromACsvFileBesideItAndKeysReplaceThem) {
  MotionFile file("shoal: 1\nmotion: m\nframes: m.csv\nkeys: [{at_s: 0.01, joints: {b: 90}}]\n");
  std::ofstream(file.folder.file("m.csv")) << "t_s,a,b\n0,0.1,0.2\n0.008,0.3,0.4\n";
  const auto tracks = file.load().tracks();
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].keys.size(), 2u);
  ASSERT_EQ(tracks[1].keys.size(), 1u);
  EXPECT_NEAR(tracks[1].keys[0].value, 90 * deg, 1e-15);
}

TEST(JointMotion, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& more) { return MotionFile("shoal: 1\nmotion: m\n" + more).error(); };
  EXPECT_EQ(error(""), "FILE:1:1: needs 'keys' or 'frames'");
  EXPECT_EQ(error("keys: [{at_s: 0, pose: sit}]\n"), "FILE:3:24: key 1: 'pose' names no pose 'sit'; known poses: none");
  EXPECT_THAT(error("keys: [{at_s: 0}]\n"), HasSubstr("FILE:3:8: key 1: needs a 'pose' or 'joints'"));
  EXPECT_THAT(error("keys: [{at_s: 0, joints: {a: x}}]\n"), HasSubstr("FILE:3:30: key 1: 'a' must be a number"));
  EXPECT_THAT(error("keys: [{at_s: 1, joints: {a: 1}}, {at_s: 1, joints: {a: 1}}]\n"),
              HasSubstr("key 2: 'at_s' must be above that of the key before, 1, got 1"));
  EXPECT_THAT(error("keys: [{at_s: -1, joints: {a: 1}}]\n"), HasSubstr("'at_s' must be >= 0 and <= 86400, got -1"));
  EXPECT_THAT(error("angles: grad\nkeys: [{at_s: 0, joints: {a: 1}}]\n"),
              HasSubstr("'angles' must be one of: deg, rad"));
  EXPECT_THAT(error("frames: none.csv\n"), HasSubstr("none.csv' does not exist"));
  EXPECT_THAT(error("kys: []\n"), HasSubstr("unknown key 'kys'"));
}

TEST(JointName, IsTextOfOneTo255Bytes) {
  for (const std::string& name : {std::string("hip"), std::string("linke Hüfte"), std::string(255, 'x')})
    EXPECT_EQ(sim::joint_name_error(name), "") << name;
  EXPECT_NE(sim::joint_name_error(std::string(256, 'x')), "");
  EXPECT_EQ(sim::joint_name_error(""),
            "the name of a joint must be UTF-8 text of 1 to 255 bytes without control characters, got ''");
}

TEST(JointName, HasNoControlCharactersAndNoBytesThatAreNoText) {
  EXPECT_EQ(sim::joint_name_error("hip\xe9"),
            "the name of a joint must be UTF-8 text of 1 to 255 bytes without control characters, got 'hip\\xe9'");
  for (const char* name : {"a\nb", "a\tb", "\x7f", "\x1b[31m"}) EXPECT_NE(sim::joint_name_error(name), "") << name;
}

}  // namespace
