// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/scratch_folder.hpp"

namespace {

sim::JointMotion with_end(double value, int keys = 2) {
  sim::JointMotion motion;
  motion.name = "m";
  motion.angles = sim::AngleUnit::rad;
  for (int i = 0; i < keys; ++i) motion.keys.push_back({i * 0.008, "", {{"a", value * i / (keys - 1)}}, {}, "", {}});
  return motion;
}

double end_of(const std::string& path) {
  return sim::load_motion(path).tracks()[0].keys.back().value;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(MotionFile, UndoAndRedoGoThroughItsVersions) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1));
  for (const double value : {2.0, 3.0}) {
    history.replace(with_end(value));
  }
  history.undo();
  EXPECT_EQ(end_of(path), 2);
  history.undo();
  EXPECT_EQ(end_of(path), 1);
  EXPECT_THROW(history.undo(), std::runtime_error);
  history.redo();
  history.redo();
  EXPECT_EQ(end_of(path), 3);
  EXPECT_THROW(history.redo(), std::runtime_error);
  // A new edit drops what could be redone.
  history.undo();
  history.replace(with_end(4));
  EXPECT_THROW(history.redo(), std::runtime_error);
  history.undo();
  EXPECT_EQ(end_of(path), 2);
}

TEST(MotionFile, UndoAndRedoNameTheOperation) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1));
  history.replace(with_end(2), "scale --by 2");
  history.replace(with_end(3), "set a=3");
  history.replace(with_end(4));
  EXPECT_EQ(history.undo(), "");
  EXPECT_EQ(history.undo(), "set a=3");
  EXPECT_EQ(history.undo(), "scale --by 2");
  EXPECT_EQ(history.redo(), "scale --by 2");
  EXPECT_EQ(history.redo(), "set a=3");
  EXPECT_EQ(history.undo(), "set a=3");
  EXPECT_EQ(end_of(path), 2);
}

TEST(MotionFile, ThatWouldNotBeReadAgainIsFound) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  EXPECT_NO_THROW(motion::check_readable(path, with_end(1)));
  for (const std::string& name : {std::string("caf\xe9"), std::string("a\0b", 3), std::string(256, 'x')}) {
    sim::JointMotion motion = with_end(1);
    for (sim::MotionKey& key : motion.keys) key.joints[0].first = name;
    EXPECT_THROW(motion::check_readable(path, motion), motion::EditError) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(MotionFile, ManyKeysBecomeFramesBesideItWhichGoBackToo) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1, 2000));
  EXPECT_TRUE(std::filesystem::exists(folder.file("m.csv")));
  EXPECT_EQ(sim::load_motion(path).frames[0].keys.size(), 2000u);
  history.replace(with_end(5, 2000));
  EXPECT_EQ(end_of(path), 5);
  history.undo();
  EXPECT_EQ(end_of(path), 1);
}

TEST(MotionFile, ACsvFileThatIsNotTheMotionsOwnIsForeignAndStaysWhenItGoesBack) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml"), csv = folder.file("m.csv");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1));
  EXPECT_EQ(motion::foreign_frames(path), "");
  history.replace(with_end(2));
  write_text(csv, "measured\n");
  EXPECT_EQ(motion::foreign_frames(path), csv);
  EXPECT_EQ(motion::foreign_frames(path, with_end(1, 2000)), csv);
  EXPECT_EQ(motion::foreign_frames(path, with_end(1)), "");  // few keys need no frames
  history.undo();
  EXPECT_EQ(end_of(path), 1);
  EXPECT_EQ(text_of(csv), "measured\n");
  // Its own frames belong to it.
  std::filesystem::remove(csv);
  motion::write_motion(path, with_end(1, 2000));
  EXPECT_EQ(motion::foreign_frames(path), "");
}

TEST(MotionFile, FramesDoNotComeBackOverAnotherCsvFile) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml"), csv = folder.file("m.csv");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1, 2000));
  history.replace(with_end(2));
  write_text(csv, "measured\n");
  EXPECT_THROW(history.undo(), std::runtime_error);
  EXPECT_EQ(text_of(csv), "measured\n");
  EXPECT_EQ(end_of(path), 2);
}

TEST(MotionFile, KeepsASymbolicLinkAndThePermissions) {
  namespace fs = std::filesystem;
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml"), link = folder.file("link.yaml");
  motion::write_motion(path, with_end(1));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(path, link);
  motion::write_motion(link, with_end(2));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(end_of(path), 2);
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(MotionFile, WhatIsNoFileIsNotReplaced) {
  const test_support::ScratchFolder folder;
  const std::string pipe = folder.file("pipe.yaml");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(motion::write_motion(pipe, with_end(1)), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(MotionFile, ThatCouldNotBeReadAgainIsNotWrittenAndLeavesNoVersion) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1));
  EXPECT_THROW(history.replace(with_end(std::numeric_limits<double>::infinity())), motion::EditError);
  EXPECT_EQ(end_of(path), 1);
  EXPECT_THROW(history.undo(), std::runtime_error);
  // Nor is one of more than a day.
  sim::JointMotion days = with_end(2);
  days.keys.back().at_s = 1e6;
  EXPECT_THROW(motion::write_motion(path, days), motion::EditError);
}

TEST(MotionFile, OtherFilesInTheHistoryAreIgnored) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  const motion::MotionHistory history(path);
  motion::write_motion(path, with_end(1));
  std::filesystem::create_directories(path + ".history");
  write_text(path + ".history/abc.undo.yaml", "mine");
  history.replace(with_end(2));
  history.undo();
  EXPECT_EQ(end_of(path), 1);
  EXPECT_EQ(text_of(path + ".history/abc.undo.yaml"), "mine");
}

TEST(MotionFile, ANameIsThatOfTheFile) {
  EXPECT_EQ(motion::motion_name_of("folder/kick_right-2.yaml"), "kick_right-2");
  EXPECT_EQ(motion::motion_name_of("my wave.yaml"), "my_wave");
}

}  // namespace
