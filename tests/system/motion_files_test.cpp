// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>

#include "motion/record/recorded_motion.hpp"
#include "tests/system/shoal_program.hpp"

// What the commands of `shoal motion` write, and what they refuse.

namespace {

using namespace system_test;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

namespace fs = std::filesystem;

class MotionFiles : public testing::Test {
 protected:
  static Ended motion(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "motion");
    return run_shoal(std::move(arguments));
  }
  std::string file(const std::string& name) const { return folder_.file(name); }
  std::string write(const std::string& name, const std::string& text) const {
    write_file(file(name), text);
    return file(name);
  }
  /// A motion of a head of two joints, with further lines.
  std::string head(const std::string& name, const std::string& more = "", double end_s = 1) const {
    return write(name, "shoal: 1\nmotion: " + fs::path(name).stem().string() + "\nvehicle: ers7\n" + more +
                           "keys:\n  - {at_s: 0, joints: {head_pan: 0, head_nod: 0}}\n  - {at_s: " +
                           std::to_string(end_s) + ", joints: {head_pan: 10}}\n");
  }
  /// A lamp with one joint, in large steps.
  std::string lamp_world() const {
    return write(
        "lamp.yaml",
        "shoal: 1\nphysics: {step_s: 0.02, gravity_mps2: 0}\nvehicles:\n  - name: lamp\n    model:\n"
        "      shoal: 1\n      vehicle: lamp\n      bodies:\n"
        "        - {name: arm, position_m: [0, 0, 1], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.2}]}\n"
        "      joints: [{name: tilt, type: hinge, bodies: [arm, world], anchor_m: [0, 0, 1.2], axis: [0, 1, "
        "0]}]\n"
        "      devices:\n        - {name: tilt, type: joint_servo, joint: tilt}\n"
        "        - {name: group, type: joint_group}\n"
        "        - {name: player, type: motion_player, group: group}\n");
  }
  std::string journal() const { return motion::journal_path(file("wave.yaml")); }
  Ended recover() const { return motion({"record", file("wave.yaml"), "--recover"}); }

  ScratchFolder folder_;
};

const std::string journal_head =
    "shoal recording 1\n{world: ers7_studio, vehicle: dog, model: ers7, joints: [head_pan, tail_pan]}\n";

TEST_F(MotionFiles, ADamagedJournalGivesWhatStandsBeforeTheDamage) {
  const std::string text = journal_head + "f 0=0 1=0\nf 0=0.01\nf 0=0.02\nf 0=zzz\nf 0=0.04\nf 0=0.05\n";
  write_file(journal(), text);
  const Ended ended = recover();
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_EQ(ended.errors, file("wave.yaml") + ": recovered a recording of 0.016 s\n" + journal() +
                              ":6: a value must be a number from -1000000 to 1000000, got 'zzz'; this line and all "
                              "after it, 3 in all, are dropped; the journal is kept as " +
                              journal() + ".bad\n");
  EXPECT_EQ(text_of_file(journal() + ".bad"), text);
  EXPECT_FALSE(fs::exists(journal()));
  EXPECT_EQ(text_of_file(file("wave_take.csv")), "t_s,head_pan\n0,0\n0.008,0.01\n0.016,0.02\n");
  // An earlier damaged journal stays.
  write_file(journal(), journal_head + "f 0=0 1=0\nf 0=0.01\nb 7\n");
  EXPECT_THAT(recover().errors, EndsWith("kept as " + journal() + ".bad2\n"));
  EXPECT_EQ(text_of_file(journal() + ".bad"), text);
}

TEST_F(MotionFiles, AJournalThatCannotBeOneGivesOneErrorAndStays) {
  const auto error_of = [&](const std::string& text) {
    write_file(journal(), text);
    const Ended ended = recover();
    EXPECT_EQ(ended.exit_code, 2) << text;
    EXPECT_EQ(std::count(ended.errors.begin(), ended.errors.end(), '\n'), 1) << ended.errors;
    EXPECT_EQ(text_of_file(journal()), text);
    EXPECT_FALSE(fs::exists(file("wave.yaml")));
    return ended.errors;
  };
  EXPECT_EQ(error_of("my notes\n"), journal() +
                                        ":1: must start with the line 'shoal recording 1'; nothing of it can be "
                                        "recovered: rename or remove it\n");
  EXPECT_THAT(error_of(journal_head + "f 0=nan 1=0\n"), HasSubstr(":3: a value must be a number"));
  EXPECT_THAT(error_of("shoal recording 1\n{joints: [a], frame_s: 1e-300}\nf 0=0\n"), HasSubstr("'frame_s' must be"));
  EXPECT_THAT(error_of("shoal recording 1\n{model: ers7, joints: [head_pan, tial_pan]}\nf 0=0 1=0\n"),
              HasSubstr(":2: joint 'tial_pan' is not a servo of vehicle 'ers7'; did you mean 'tail_pan'?"));
}

TEST_F(MotionFiles, AJournalThatIsNoFileDoesNotHang) {
  ASSERT_EQ(mkfifo(journal().c_str(), 0600), 0);
  for (int i = 0; i < 2; ++i) {
    const Ended ended = recover();
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_EQ(ended.errors, journal() + ": must be a regular file, the journal of a recording\n");
    fs::remove(journal());
    fs::create_directory(journal());
  }
}

TEST_F(MotionFiles, AJournalWithoutAFrameHoldsNothing) {
  for (const std::string& text : {std::string(), std::string("shoal rec"), journal_head, journal_head + "f 0=0"}) {
    write_file(journal(), text);
    EXPECT_THAT(recover().errors, HasSubstr("there is nothing to recover"));
    EXPECT_FALSE(fs::exists(journal()));
  }
}

TEST_F(MotionFiles, UndoAndRedoSayWhatTheyTookBack) {
  const std::string path = head("m.yaml");
  const Ended edited = motion({"edit", "scale", path, "--by", "2"});
  EXPECT_EQ(edited.output, path + ": 2.000 s, 2 joints, 2 keys; before 1.000 s, 2 joints, 2 keys\n");
  ASSERT_EQ(motion({"edit", "set", path, "--at", "1", "head_pan=20", "tail_pan=5"}).exit_code, 0);
  ASSERT_EQ(motion({"edit", "shift", path, "--by", "0.5", "--joints", "head_pan,tail_pan"}).exit_code, 0);
  EXPECT_EQ(motion({"edit", "undo", path}).output,
            path +
                ": took back 'shift --by 0.5 --joints head_pan,tail_pan'; now 2.000 s, 3 joints, 3 keys; before "
                "2.500 s, 3 joints, 4 keys\n");
  EXPECT_THAT(motion({"edit", "undo", path}).output,
              AllOf(HasSubstr(": took back 'set --at 1 head_pan=20 tail_pan=5'; now 2.000 s, 2 joints, 2 keys;")));
  EXPECT_THAT(motion({"edit", "redo", path}).output, HasSubstr(": did again 'set --at 1 head_pan=20 tail_pan=5'; now"));
  // A version of which nothing is known.
  for (const auto& entry : fs::directory_iterator(path + ".history"))
    if (entry.path().extension() == ".txt") fs::remove(entry.path());
  EXPECT_THAT(motion({"edit", "undo", path}).output, HasSubstr(": took back the last change; now"));
}

TEST_F(MotionFiles, AMotionOfMoreThanAnHourIsPlayedToItsEnd) {
  const std::string slow = write("slow.yaml",
                                 "shoal: 1\nmotion: slow\nkeys: [{at_s: 0, joints: {tilt: 0}}, "
                                 "{at_s: 3700, joints: {tilt: 10}}]\n");
  const Ended ended = motion({"play", slow, "--world", lamp_world(), "--again-from", "3699"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, testing::ContainsRegex("\n3700\\.[0-9]+ s simulated, state hash at the end of the motion"));
  EXPECT_THAT(ended.output, HasSubstr("again from 3699."));
  EXPECT_THAT(ended.output, HasSubstr("the same final state"));
}

TEST_F(MotionFiles, TheWayToTheFirstValuesHasALeastVelocity) {
  const std::string path = head("m.yaml", "start: {max_velocity: 1e-300}\n");
  EXPECT_EQ(motion({"show", path}).errors,
            path + ":4:23: start: 'max_velocity' must be >= 0.001 and <= 1000, got 1e-300\n");
}

TEST_F(MotionFiles, AnInstantToPlayAgainFromIsWithinTheMotion) {
  const std::string path = head("m.yaml"), world = source("worlds/ers7_studio.yaml");
  for (const std::string at : {"-1", "1.5", "nan", "1e300"}) {
    const Ended ended = motion({"play", path, "--world", world, "--again-from", at});
    EXPECT_EQ(ended.exit_code, 2) << at;
    EXPECT_EQ(ended.output, "");
    EXPECT_THAT(ended.errors, HasSubstr("--again-from must be from 0 to 1 s, the end of the motion, got "));
  }
  EXPECT_EQ(motion({"play", path, "--world", world, "--again-from", "1"}).exit_code, 0);
  const std::string loop = head("loop.yaml", "loop: true\n", 5);
  EXPECT_THAT(motion({"play", loop, "--world", world, "--loop-time", "2", "--again-from", "4"}).errors,
              HasSubstr("--again-from: 4 s of the motion are not reached in --loop-time 2"));
}

TEST_F(MotionFiles, OutputsAreCheckedBeforeTheWork) {
  const std::string world = source("worlds/ers7_studio.yaml"), pipe = file("pipe.yaml");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink(file("nowhere"), file("link.yaml"));
  fs::create_directory(file("folder.yaml"));
  const std::vector<std::pair<std::string, std::string>> outputs{
      {pipe, "it is not a regular file"},
      {file("link.yaml"), "it is a symbolic link to nothing"},
      {file("folder.yaml"), "it is a folder"},
      {file("none/walk.yaml"), "no such folder"},
      {file(std::string(250, 'x')), "File name too long"},
      {file("walk.csv"), "must not end in .csv"}};
  for (const auto& [output, error] : outputs)
    for (std::vector<std::string> command :
         {std::vector<std::string>{"connect", "bow", "crouch"}, std::vector<std::string>{"evolve"}}) {
      // The world does not exist: it is loaded later.
      command.insert(command.end(), {"--world", file("no_world.yaml"), "--output", output, "--overwrite"});
      const Ended ended = motion(command);
      EXPECT_THAT(ended.errors, AllOf(HasSubstr(output), HasSubstr(error))) << command[0];
      EXPECT_NE(ended.exit_code, 0);
    }
  const Ended same = motion({"evolve", "--world", world, "--output", file("walk.yaml"), "--page", file("walk.yaml")});
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_THAT(same.errors, HasSubstr("must not be a file of the motion"));
  EXPECT_FALSE(fs::exists(file("walk.yaml")));
}

TEST_F(MotionFiles, AListWithoutANameIsAnError) {
  const std::string path = head("m.yaml"), before = text_of_file(path);
  for (const std::string list : {",", "head_pan,", ",,head_pan", ""}) {
    const Ended shifted = motion({"edit", "shift", path, "--by", "1", "--joints=" + list});
    EXPECT_EQ(shifted.exit_code, 2) << list;
    EXPECT_THAT(shifted.errors, HasSubstr("--joints")) << list;
    const Ended recorded = motion({"record", path, "--world", "ers7_studio", "--overdub=" + list});
    EXPECT_EQ(recorded.exit_code, 2) << list;
    EXPECT_THAT(recorded.errors, HasSubstr("--overdub")) << list;
  }
  EXPECT_THAT(motion({"record", path, "--world", "ers7_studio", "--overdub", ","}).errors,
              HasSubstr("--overdub: must be names, comma separated, got ','"));
  EXPECT_THAT(run_shoal({"run", source("worlds/minimal.yaml"), "--await", ","}).errors,
              HasSubstr("--await: must be names, comma separated, got ','"));
  EXPECT_EQ(text_of_file(path), before);
}

TEST_F(MotionFiles, AnImportWritesNothingThatCouldNotBeReadAgain) {
  write("bad.motion", "#WEBOTS_MOTION,V1.0,hip,caf\xe9\n00:00:000,Pose1,0,0\n");
  const Ended bad = motion({"import", file("bad.motion"), "--output", file("bad.yaml")});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.errors, file("bad.motion") +
                            ":1:25: the name of a joint must be UTF-8 text of 1 to 255 bytes without "
                            "control characters, got 'caf\\xe9'\n");
  // The loop would end after a day and a second.
  write("day.motion", "#WEBOTS_MOTION,V1.0,hip\n00:00:000,Pose1,0\n1440:00:000,Pose2,0\n");
  const Ended day = motion({"import", file("day.motion"), "--output", file("day.yaml"), "--loop-step-ms", "1000"});
  EXPECT_EQ(day.exit_code, 2);
  EXPECT_THAT(day.errors, HasSubstr("day.yaml' is not written, because it would be invalid: day.yaml:"));
  for (const char* name : {"bad.yaml", "day.yaml"}) EXPECT_FALSE(fs::exists(file(name)));
  // Notes are kept.
  write("note.motion", "#WEBOTS_MOTION,V1.0,hip\n00:00:000,caf\xe9,0\n");
  const Ended note = motion({"import", file("note.motion"), "--output", file("note.yaml")});
  EXPECT_EQ(note.exit_code, 0);
  EXPECT_THAT(note.errors, StartsWith(file("note.motion") + ": names of poses with bytes that are not UTF-8"));
  EXPECT_EQ(motion({"show", file("note.yaml")}).exit_code, 0);
}

}  // namespace
