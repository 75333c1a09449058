// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <map>
#include <numbers>
#include <stdexcept>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(MotFormat, StartsWithTheApproachBecauseKeysAtZeroAreReplaced) {
  sim::JointMotion motion =
      test::motion({{0, {{"lf_swing", 0.25}, {"lf_knee", 1}}}, {0.3, {{"lf_swing", 0.5}}}, {1, {{"lf_swing", 0}}}});
  motion.start.min_s = 0.75;
  const test::Written file = test::written("mot", motion, test::leg_names());
  EXPECT_EQ(file.bytes,
            "#MSq\nradians\nsetTime\t750\nLFr:rotor\t0.250000\nLFr:knee\t1.000000\n"
            "advanceTime\t300\nLFr:rotor\t0.500000\n"
            "advanceTime\t700\nLFr:rotor\t0.000000\nLFr:knee\t1.000000\n#END\n");
  EXPECT_THAT(file.losses, IsEmpty());
  const test::Read again = test::read("mot", file.bytes, test::leg_names());
  EXPECT_DOUBLE_EQ(again.motion.start.min_s, 0.75);
  EXPECT_DOUBLE_EQ(again.motion.end_s(), 1);
  EXPECT_DOUBLE_EQ(test::value(again.motion, "lf_swing", 0), 0.25);
  EXPECT_DOUBLE_EQ(test::value(again.motion, "lf_knee", 0.5), 1);
}

TEST(MotFormat, FindsOutputsAsTekkotsu) {
  const test::Read file = test::read("mot",
                                     "#MSq\n# remark\nadvanceTime 99\nLFr:knee~~~ 1\nFr:rotor 0.5\nNECK:roll "
                                     "0\nLED:face 1\ndegrees\nDELAY 100\nLFr:kn 90\n#END\nrubbish",
                                     test::leg_names());
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_swing", 0), 0.5) << "a name without L or R sets both sides";
  EXPECT_DOUBLE_EQ(test::value(file.motion, "rf_swing", 0), 0.5);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_knee", 0), 1);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_knee", 0.1), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(file.motion.start.min_s, 0.1) << "the playhead starts at 1 ms";
  EXPECT_THAT(file.losses, ElementsAre("outputs that vehicle 'leg' does not have are left out: NECK:roll, LED:face"));
}

TEST(MotFormat, KeepsTheLightsOfTheVehicle) {
  const motion::JointNames names{
      "leg",
      {{"knee", "", 0, false}, {"face_a", "", 0, false, true}},
      {{"tekkotsu", "", false, {{"knee", "LFr:knee"}, {"face_a", "LED:faceA"}, {"face_b", "LED:faceB"}}}}};
  const std::string bytes =
      "#MSq\nradians\nsetTime\t500\nLFr:knee\t1.000000\nLED:faceA\t0.250000\n"
      "advanceTime\t100\nLFr:knee\t1.000000\nLED:faceA\t1.000000\n#END\n";
  const test::Read file = test::read("mot", bytes, names);
  EXPECT_THAT(file.motion.lights, ElementsAre("face_a"));
  EXPECT_DOUBLE_EQ(test::value(file.motion, "face_a", 0.05), 0.625);
  EXPECT_THAT(file.losses, IsEmpty());
  const test::Written again = test::written("mot", file.motion, names);
  EXPECT_EQ(again.bytes, bytes);
  EXPECT_THAT(again.losses, IsEmpty());
  // A light that the list names, but the vehicle does not have.
  EXPECT_THAT(test::read("mot", "#MSq\nsetTime 9\nLFr:knee 1\nLED:faceB 1\n#END\n", names).losses,
              ElementsAre("outputs that vehicle 'leg' does not have are left out: LED:faceB"));
}

TEST(MotFormat, LightsAndSoundsAreLossesOfFormatsWithoutThem) {
  sim::JointMotion motion = test::motion({{0, {{"lf_swing", 0.25}, {"face_a", 1}}}, {1, {{"face_a", 0}}}});
  motion.lights = {"face_a"};
  motion.sounds = {{0.5, "bark", 1}};
  const test::Written file = test::written("webots", motion);
  EXPECT_THAT(file.losses, ElementsAre("intensities of 1 light are not kept", "1 sound is not kept"));
  EXPECT_THAT(file.bytes, testing::Not(HasSubstr("face_a")));
  motion.keys = {motion.keys[1]};
  EXPECT_EQ(test::error_of([&] { test::written("webots", motion); }), "motion 'wave': needs a joint");
}

TEST(MotFormat, LeavesOutKeysAtZeroAndKeysWithoutWeight) {
  const test::Read file = test::read(
      "mot",
      "#MSq\nsetTime 0\nLFr:knee 3\nsetTime 500\nLFr:knee 1\nLFr:rotor 0.5 0\nsetTime 700\nLFr:rotor 0.75 0.5\n#END\n",
      test::leg_names());
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_knee", 0), 1);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_swing", 0), 0.75);
  EXPECT_DOUBLE_EQ(file.motion.end_s(), 0.2);
  EXPECT_THAT(file.losses, ElementsAre(HasSubstr("weights other than 0 and 1 are not kept, such as in line 8"),
                                       HasSubstr("keys at time 0 are left out"), HasSubstr("keys of weight 0"),
                                       HasSubstr("first key is after 0.5 s")));
}

TEST(MotFormat, LoadsPosturesAndMotionsOfItsFolder) {
  const std::map<std::string, std::string> files{{"stand.pos", "#POS\nLFr:knee 0.5 1\n#END\n"},
                                                 {"kick.mot", "#MSq\nsetTime 100\nLFr:knee 2\n#END\n"}};
  const auto load = [&](const std::string& name) {
    if (!files.contains(name)) throw std::runtime_error("does not exist");
    return files.at(name);
  };
  motion::Losses losses;
  const motion::JointNames names = test::leg_names();
  const motion::FormatOptions options;
  const auto read = [&](const std::string& bytes) {
    return motion::motion_of_bytes(*motion::find_motion_format("mot"), {bytes, "file", names, options, load}, losses);
  };
  const sim::JointMotion motion = read("#MSq\nsetTime 200\nload stand.pos\nload kick.mot\nLFr:rotor 1\n#END\n");
  EXPECT_DOUBLE_EQ(test::value(motion, "lf_knee", 0), 0.5);
  EXPECT_DOUBLE_EQ(test::value(motion, "lf_knee", 0.1), 2);
  EXPECT_EQ(test::error_of([&] { read("#MSq\nload no.pos\n#END\n"); }), "file:2:6: file 'no.pos' does not exist");
  EXPECT_EQ(test::error_of([&] { read("#MSq\nload ../x.pos\n#END\n"); }),
            "file:2:6: the file must be in the folder of this one, got '../x.pos'");
}

TEST(MotFormat, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& text) {
    return test::read_error("mot", "#MSq\n" + text, test::leg_names());
  };
  EXPECT_EQ(test::read_error("mot", "MSq\n"), "file:1:1: must start with '#MSq' or '#POS'");
  EXPECT_EQ(error("LFr:knee 1\n"), "file:2:1: must end with the line '#END'");
  EXPECT_EQ(error("delay\n#END\n"), "file:2:1: must have a command and a time in ms");
  EXPECT_EQ(error("delay -5\n#END\n"), "file:2:7: the time in ms must be a whole number from 0 to 86399999, got '-5'");
  EXPECT_EQ(error("LFr:knee\n#END\n"), "file:2:1: needs a value after the name 'LFr:knee'");
  EXPECT_EQ(error("LFr:knee x\n#END\n"), "file:2:10: the value must be a number from -1000000 to 1000000, got 'x'");
  EXPECT_EQ(error("LFr:knee 1 1 1\n#END\n"), "file:2:14: must end after name, value and weight, got '1'");
  EXPECT_EQ(error("LFr: 1\n#END\n"), "file:2:1: must name one output, and may mean LFr:rotor, LFr:knee, got 'LFr:'");
  EXPECT_EQ(error("load other.pos\n#END\n"), "file:2:6: other files cannot be loaded here, got 'other.pos'");
  EXPECT_EQ(error(std::string(64, 'x') + " 1\n#END\n").substr(0, 50),
            "file:2:1: a word must have at most 63 bytes, got '");
  EXPECT_EQ(error("LED:face 1\n#END\n"), "file: needs the value of an output of the vehicle after time 0");
}

TEST(MotFormat, HasAtMost200Outputs) {
  std::string text = "#MSq\n";
  for (int i = 0; i < 201; ++i) text += "joint" + std::to_string(i) + " 1\n";
  EXPECT_EQ(test::read_error("mot", text + "#END\n"), "file:202:1: must have at most 200 outputs");
}

TEST(PosFormat, HoldsOneInstant) {
  const sim::JointMotion motion = test::motion({{0, {{"lf_swing", 0}}}, {1, {{"lf_swing", 1}}}});
  EXPECT_EQ(test::error_of([&] { test::written("pos", motion, test::leg_names()); }),
            "motion 'wave': a posture holds one instant of 1 s: choose it (--at)");
  motion::FormatOptions options;
  options.at_s = 0.25;
  const test::Written file = test::written("pos", motion, test::leg_names(), options);
  EXPECT_EQ(file.bytes, "#POS\nLFr:rotor\t0.250000\t1\n#END\n");
  EXPECT_THAT(file.losses, ElementsAre("only the pose at 0.25 s is kept"));
}

TEST(PosFormat, ReadsThePartsThatAreOutputs) {
  const test::Read file = test::read("pos",
                                     "#POS\n<meta-info>\n timestamp 12\n</meta-info>\nLFr:rotor = -0.79 1.00 # "
                                     "remark\n<sensors>\nIR 5\n</sensors>\n#END\n",
                                     test::leg_names());
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_swing", 0), -0.79);
  EXPECT_THAT(file.losses, IsEmpty());
  EXPECT_EQ(
      test::read_error("pos", "#POS\ncondensed ERS-7\n#END\n", test::leg_names()),
      "file:2:1: postures for a single robot model are not supported: must be a name of an output, got 'condensed'");
}

}  // namespace
