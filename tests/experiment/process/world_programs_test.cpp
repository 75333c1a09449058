// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/world_programs.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "sim/config/diagnostics.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// A folder of programs in place of the one of the running program.
class WorldPrograms : public testing::Test {
 protected:
  WorldPrograms() {
    fs::create_directories(folder_ / "mine");
    write("shoal-rover",
          "args:\n  - {name: name, type: text, required: true}\n"
          "  - {name: waypoints_m, type: tuples, columns: [x, y]}\n");
    write("mine/pilot", "args: [{name: speed_mps, type: number}]\n");
  }
  ~WorldPrograms() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& args) {
    std::ofstream(folder_ / (name + ".args.yaml"))
        << "shoal_args: 1\nprogram: " << fs::path(name).filename().string() << "\n"
        << args;
  }
  sim::LoadedWorld load(const std::string& processes, const std::vector<std::string>& sets = {}) {
    return sim::load_world_text("shoal: 1\nprocesses:\n" + processes, "worlds/test.yaml", {sets, {}});
  }
  sim::LoadedWorld read(const std::string& processes, const std::vector<std::string>& sets = {}) {
    sim::LoadedWorld loaded = load(processes, sets);
    experiment::read_programs(loaded, {true, {(folder_ / "mine").string()}, {folder_.string()}});
    return loaded;
  }
  std::vector<std::string> errors(const std::string& processes, const std::vector<std::string>& sets = {}) {
    try {
      read(processes, sets);
      return {};
    } catch (const sim::ConfigError& error) {
      return error.lines();
    }
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("world_programs_" + std::to_string(::getpid()));
};

TEST_F(WorldPrograms, ArgumentsBecomeTheCommand) {
  const sim::LoadedWorld loaded = read(
      "  - {name: r, program: shoal-rover, args: {name: r1, waypoints_m: [[1, 2]]}}\n"
      "  - {name: p, program: pilot}\n  - {name: q, command: [pilot, --fast]}\n");
  EXPECT_THAT(loaded.config.processes[0].command,
              ElementsAre(folder_ / "shoal-rover", "--name=r1", "--waypoints-m=[[1,2]]"));
  EXPECT_THAT(loaded.config.processes[1].command, ElementsAre(folder_ / "mine/pilot"));
  EXPECT_THAT(loaded.config.processes[2].command, ElementsAre("pilot", "--fast"));
}

TEST_F(WorldPrograms, WrongArgumentsAreNamedWithTheirPlaceAndAllAtOnce) {
  EXPECT_THAT(errors("  - {name: rover1, program: shoal-rover, args: {name: r1, waypoints_m: [[1, 2], [3]]}}\n"
                     "  - {name: p, program: pilot, args: {speed: 1}}\n"),
              ElementsAre("worlds/test.yaml:3:81: process 'rover1': program 'shoal-rover': 'waypoints_m[2]' must be 2 "
                          "numbers, got 1",
                          "worlds/test.yaml:4:38: process 'p': program 'pilot': unknown argument 'speed'; did you "
                          "mean 'speed_mps'?"));
  EXPECT_THAT(errors("  - {name: r, program: shoal-rover}\n"),
              ElementsAre("worlds/test.yaml:3:24: process 'r': program 'shoal-rover': missing argument 'name'"));
}

TEST_F(WorldPrograms, BridgesAreProcessesWithAListOfTheirOwn) {
  const std::string bridges =
      "  - {name: p, command: [pilot]}\nbridges:\n  - {name: moos, program: shoal-rover, args: {name: r1}}\n"
      "  - {name: ros2, client: ros2, program: pilot}\n";
  const sim::LoadedWorld loaded = read(bridges, {"bridges.moos.args.name=r2"});
  ASSERT_EQ(loaded.config.processes.size(), 3U);
  EXPECT_THAT(loaded.config.processes[1].command, ElementsAre(folder_ / "shoal-rover", "--name=r2"));
  EXPECT_FALSE(experiment::written_process(loaded, 0).is_bridge);
  EXPECT_TRUE(experiment::written_process(loaded, 1).is_bridge);
  EXPECT_THAT(experiment::free_bridges(loaded), ElementsAre("moos"));  // the other one is a client in lockstep
  EXPECT_THAT(errors("bridges: [{name: moos, program: shoal-rover, args: {peer: 10.0.0.1, name: r1}}]\n"),
              ElementsAre(HasSubstr("bridge 'moos': program 'shoal-rover': unknown argument 'peer'")));
}

TEST_F(WorldPrograms, TheCommandLineChangesArguments) {
  const std::string processes = "  - {name: r, program: shoal-rover, args: {name: r1}}\n";
  EXPECT_THAT(read(processes, {"processes.r.args.waypoints_m=[[5, 6]]", "processes.r.args.name=other"})
                  .config.processes[0]
                  .command,
              ElementsAre(testing::_, "--name=other", "--waypoints-m=[[5,6]]"));
  EXPECT_THAT(errors(processes, {"processes.r.args.waypoints_m=[[5]]"}),
              ElementsAre(HasSubstr("--set processes.r.args.waypoints_m=[[5]]:1:2: process 'r': program "
                                    "'shoal-rover': 'waypoints_m[1]' must be 2 numbers, got 1")));
}

TEST_F(WorldPrograms, AProgramWithoutADeclarationIsNamedWithWhereItWasLookedFor) {
  EXPECT_THAT(errors("  - {name: p, program: navigator}\n"),
              ElementsAre("worlds/test.yaml:3:24: process 'p': program 'navigator': no declaration "
                          "'navigator.args.yaml' in " +
                          folder_.string() + ", " + (folder_ / "mine").string() +
                          "; 'command: [navigator, ...]' takes a program without one"));
  EXPECT_THAT(errors("  - {name: p, program: shoal-rovar}\n"), ElementsAre(HasSubstr("did you mean 'shoal-rover'?")));
  EXPECT_THAT(errors("  - {name: p, program: ./navigator}\n"),
              ElementsAre(HasSubstr("no declaration './navigator.args.yaml'; 'command: [./navigator, ...]' takes")));
  sim::LoadedWorld loaded = load("  - {name: p, program: navigator}\n");
  experiment::read_programs(loaded, {false, {}, {folder_.string()}});
  EXPECT_THAT(loaded.config.processes[0].command, ElementsAre());
}

TEST_F(WorldPrograms, OtherWaysOfNamingAProgramAreErrors) {
  const auto error = [&](const std::string& keys) {
    try {
      load("  - {name: p, " + keys + "}\n");
      return std::string();
    } catch (const sim::ConfigError& wrong) {
      return std::string(wrong.what());
    }
  };
  EXPECT_EQ(error("program: a, command: [a]"),
            "worlds/test.yaml:3:5: process 'p': needs either 'program' or 'command', not both");
  EXPECT_EQ(error("client: a"), "worlds/test.yaml:3:5: process 'p': needs either 'program' with 'args' or 'command'");
  EXPECT_EQ(
      error("command: [a], args: {b: 1}"),
      "worlds/test.yaml:3:35: process 'p': 'args' needs 'program'; the arguments of 'command' belong into its list");
  EXPECT_EQ(error("command: pilot --fast"),
            "worlds/test.yaml:3:24: process 'p': 'command' must be a list; write 'command: [pilot, --fast]'");
  EXPECT_EQ(error("program: a, args: [1]"), "worlds/test.yaml:3:33: process 'p': 'args' must be a map, got [1]");
}

}  // namespace
