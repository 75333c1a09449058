// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/system/shoal_program.hpp"

// Commands other than `run` are in libraries beside the program, which a checkout builds when they are first called.

namespace {

namespace fs = std::filesystem;

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

/// A build folder with the program alone, of a checkout whose build says what it does, and copies the library.
class CommandLibrary : public testing::Test {
 protected:
  CommandLibrary() {
    for (const char* name : {"source/worlds", "source/vehicles", "source/tools", "build/bin", "build/lib/shoal"})
      fs::create_directories(folder_.file(name));
    write_file(folder_.file("build/CMakeCache.txt"), "CMAKE_HOME_DIRECTORY:INTERNAL=" + folder_.file("source") + "\n");
    fs::copy_file(built("shoal"), shoal_);
    set_build("echo building $2 of $4 >&2; cp -r " + built("../lib/shoal/.") + " $3/lib/shoal");
  }

  /// What stands for tools/build_progress.
  void set_build(const std::string& commands) {
    const std::string path = folder_.file("source/tools/build_progress");
    write_file(path, "#!/bin/sh\n" + commands + "\n");
    fs::permissions(path, fs::perms::owner_all);
  }

  Ended film_help() {
    Program program({shoal_, "film", "--help"});
    const int exit_code = program.wait();
    return {exit_code, program.output(), program.errors()};
  }

  ScratchFolder folder_;
  const std::string shoal_ = folder_.file("build/bin/shoal");
};

TEST_F(CommandLibrary, IsBuiltWhenItsCommandIsFirstCalled) {
  const Ended first = film_help();
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(first.errors, "building film of shoal_film\n");
  EXPECT_THAT(first.output, HasSubstr("Usage: shoal film"));
  const Ended second = film_help();
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_EQ(second.errors, "");
}

TEST_F(CommandLibrary, IsBuiltAgainWhenTheProgramIsNewer) {
  film_help();
  fs::last_write_time(shoal_, fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(film_help().errors, "building film of shoal_film\n");
}

TEST_F(CommandLibrary, ThatCannotBeBuiltIsOneErrorWithTheCommandThatSaysMore) {
  set_build("exit 1");
  const Ended ended = film_help();
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_EQ(ended.errors, "shoal: the commands of 'film' could not be built; `cmake --build " + folder_.file("build") +
                              " --target shoal_film` says more\n");
}

TEST_F(CommandLibrary, IsNotNeededForTheListOfCommands) {
  Program program({shoal_, "--help"});
  EXPECT_EQ(program.wait(), 0);
  EXPECT_EQ(program.errors(), "");
  EXPECT_THAT(program.output(), HasSubstr("  film "));
}

TEST_F(CommandLibrary, ThatOnlyRegistersItselfIsLoadedWithThoseThatUseIt) {
  // No symbol of ros2.so is called: without it each message would be one of LCM.
  const std::string log = folder_.file("run.lcm"), mcap = folder_.file("run.mcap");
  Program run({built("shoal"), "run", source("worlds/minimal.yaml"), "--bus", "none", "--speed", "max", "--duration",
               "1", "--quiet", "--record", log});
  ASSERT_LE(run.wait(), 1) << run.errors();
  Program convert({built("shoal"), "log", "mcap", log, "--out", mcap});
  EXPECT_EQ(convert.wait(), 0) << convert.errors();
  EXPECT_THAT(text_of_file(mcap), HasSubstr("tf2_msgs/msg/TFMessage"));
}

TEST_F(CommandLibrary, ThatAnInstallationLacksIsOneError) {
  fs::remove(folder_.file("build/CMakeCache.txt"));
  const Ended ended = film_help();
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors,
              HasSubstr("shoal: the commands of 'film' cannot be loaded: " + folder_.file("build/lib/shoal/film.so")));
  EXPECT_THAT(ended.errors, Not(HasSubstr("building")));
}

}  // namespace
