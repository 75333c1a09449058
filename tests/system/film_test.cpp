// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "sim/image/image_file.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;

Ended film(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "film");
  return run_shoal(arguments);
}

bool is_installed(const std::string& program) {
  std::istringstream folders(std::getenv("PATH"));
  std::string folder;
  while (std::getline(folders, folder, ':'))
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

TEST(Film, ShowsAWorldWithoutItsPrograms) {
  const ScratchFolder folder;
  const Ended ended = film({source("worlds/coop_land.yaml"), "--to", "0.2", "--fps", "10", "--size", "64x48",
                            "--overlay", "all", "--out", folder.file("a.avi")});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("a.avi: 3 frames of 64x48"));
  EXPECT_THAT(ended.errors, HasSubstr("without its 3 programs"));
  EXPECT_TRUE(std::filesystem::exists(folder.file("a.avi")));
}

TEST(Film, HasTheSizeAndTheDurationThatFfprobeReads) {
  if (!is_installed("ffmpeg") || !is_installed("ffprobe")) GTEST_SKIP() << "without the package ffmpeg";
  const ScratchFolder folder;
  for (const char* name : {"a.mp4", "a.webm", "a.avi"}) {
    const Ended ended = film(
        {source("worlds/minimal.yaml"), "--to", "0.9", "--fps", "10", "--size", "128x96", "--out", folder.file(name)});
    ASSERT_EQ(ended.exit_code, 0) << ended.errors;
    Program probe({"ffprobe", "-v", "error", "-count_frames", "-show_entries",
                   "stream=width,height,nb_read_frames,r_frame_rate:format=duration", "-of",
                   "default=noprint_wrappers=1", folder.file(name)});
    ASSERT_EQ(probe.wait(), 0) << probe.errors();
    for (const char* line : {"width=128\n", "height=96\n", "nb_read_frames=10\n", "r_frame_rate=10/1\n"})
      EXPECT_THAT(probe.output(), HasSubstr(line)) << name;
    EXPECT_THAT(probe.output(), HasSubstr("duration=1.0")) << name;
  }
}

TEST(Film, HasOneErrorForEachMistake) {
  const ScratchFolder folder;
  const std::string world = source("worlds/minimal.yaml"), out = folder.file("a.avi");
  const auto exit_code = [&](std::vector<std::string> more, const std::string& text) {
    more.insert(more.begin(), world);
    const Ended ended = film(more);
    EXPECT_THAT(ended.errors, HasSubstr(text));
    return ended.exit_code;
  };
  EXPECT_EQ(exit_code({"--out", folder.file("a.mov")}, "--out: must end in .mp4"), 2);
  EXPECT_EQ(exit_code({"--out", folder.file("no/a.avi")}, "no such folder"), 4);
  EXPECT_EQ(exit_code({"--out", out, "--camera", "chase:nobody"}, "there is no vehicle 'nobody'"), 2);
  EXPECT_EQ(exit_code({"--out", out, "--size", "64"}, "--size: must be such as 1280x720"), 2);
  EXPECT_EQ(exit_code({"--out", out, "--overlay", "tracks"}, "--overlay: must be trails"), 2);
  EXPECT_EQ(exit_code({"--out", out, "--visibility", "-1"}, "--visibility: must be from"), 2);
  EXPECT_EQ(exit_code({"--out", out, "--from", "2", "--to", "1"}, "--to: must not be before --from"), 2);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
