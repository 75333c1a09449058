// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/system/shoal_program.hpp"

// What someone meets who has just installed or built the program: names instead of paths, a start for files of one's
// own, and clients that say what they wait for.

namespace {

namespace fs = std::filesystem;

using namespace system_test;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Runs `shoal` in another folder.
Ended shoal_in(const std::string& folder, const std::string& arguments, const std::string& shoal = built("shoal")) {
  Program program({"sh", "-c", "cd '" + folder + "' && exec '" + shoal + "' " + arguments});
  const int exit_code = program.wait();
  return {exit_code, program.output(), program.errors()};
}

TEST(ShippedFiles, AWorldIsRunByItsNameFromAnyFolder) {
  const ScratchFolder folder;
  const Ended by_name = shoal_in(folder.file(""), "run minimal --bus none --duration 1 --speed max");
  EXPECT_EQ(by_name.exit_code, 0) << by_name.errors;
  const Ended by_path =
      run_shoal({"run", source("worlds/minimal.yaml"), "--bus", "none", "--duration", "1", "--speed", "max"});
  EXPECT_EQ(state_hash_in(by_name), state_hash_in(by_path));
  EXPECT_EQ(shoal_in(folder.file(""), "check minimal").exit_code, 0);
  EXPECT_EQ(shoal_in(folder.file(""), "check rover").exit_code, 0);
  EXPECT_EQ(shoal_in(folder.file(""), "medium otter_sea").exit_code, 0);
}

TEST(ShippedFiles, AFileOfOnesOwnComesBeforeAShippedOne) {
  const ScratchFolder folder;
  write_file(folder.file("minimal.yaml"), "shoal: 1\nname: mine\n");
  EXPECT_THAT(shoal_in(folder.file(""), "check minimal").output, HasSubstr("world 'mine'"));
}

TEST(ShippedFiles, ANameThatMeansNothingSaysWhichOneIsMeant) {
  const ScratchFolder folder;
  const Ended ended = shoal_in(folder.file(""), "run minmal --bus none");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.errors,
            "'minmal': there is no such file here, nor 'minmal.yaml', nor a shipped world of this name; did you mean "
            "'minimal'?\n");
  EXPECT_THAT(shoal_in(folder.file(""), "study zzzzzz").errors, HasSubstr("see `shoal list studies`"));
}

TEST(ShippedFiles, ListSaysWhatEachIs) {
  const Ended ended = run_shoal({"list"});
  EXPECT_EQ(ended.exit_code, 0);
  for (const char* folder : {"worlds", "vehicles", "worlds/studies"})
    for (const fs::directory_entry& entry : fs::directory_iterator(source(folder))) {
      if (entry.path().extension() != ".yaml") continue;
      const std::string name = entry.path().stem().string();
      EXPECT_THAT("\n" + ended.output, ContainsRegex("\n +" + name + " +[A-Z0-9]")) << "a name and its description";
    }
  EXPECT_THAT(run_shoal({"list", "worlds"}).output, Not(HasSubstr("rover_small")));
}

TEST(ShippedFiles, AProgramInstalledElsewhereFindsThoseBesideIt) {
  const ScratchFolder folder;
  fs::create_directories(folder.file("prefix/bin"));
  fs::create_directories(folder.file("prefix/share/shoal/vehicles"));
  fs::create_directories(folder.file("prefix/share/shoal/worlds"));
  fs::copy_file(built("shoal"), folder.file("prefix/bin/shoal"));
  write_file(folder.file("prefix/share/shoal/worlds/pond.yaml"), "shoal: 1\ndescription: A pond.\n");
  const Ended ended = shoal_in("/", "list worlds", folder.file("prefix/bin/shoal"));
  EXPECT_EQ(ended.output, "  pond  A pond.\n") << ended.errors;
  fs::remove_all(folder.file("prefix/share"));
  const Ended none = shoal_in("/", "list", folder.file("prefix/bin/shoal"));
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_THAT(none.errors, HasSubstr("finds no shipped worlds"));
}

TEST(New, WritesWorldsAndVehiclesThatCheckAcceptsAndThatRun) {
  const ScratchFolder folder;
  const std::string here = folder.file("");
  for (const char* command :
       {"new world yard", "new world bay --under-water", "new vehicle digger", "new world pit --vehicle digger.yaml",
        "new vehicle fish --under-water", "new world pond --under-water --vehicle fish.yaml"}) {
    const Ended ended = shoal_in(here, command);
    EXPECT_EQ(ended.exit_code, 0) << command << ": " << ended.errors;
  }
  for (const char* vehicle : {"digger.yaml", "fish.yaml"}) {
    const Ended checked = shoal_in(here, std::string("check ") + vehicle);
    EXPECT_EQ(checked.exit_code, 0) << checked.errors;
    EXPECT_EQ(checked.errors, "") << vehicle;
  }
  for (const std::string name : {"yard", "bay", "pit", "pond"}) {
    const Ended check = shoal_in(here, "check " + name + ".yaml");
    EXPECT_EQ(check.exit_code, 0) << name << check.errors;
    EXPECT_EQ(check.errors, "") << name;
    const Ended run = shoal_in(here, "run " + name + " --bus none --speed max --duration 8 --results out_" + name);
    EXPECT_EQ(run.exit_code, 0) << name << run.errors;
    EXPECT_THAT(summary_value(folder.file("out_" + name), "metrics"), HasSubstr("{"));
    const std::string text = text_of_file(folder.file(name + ".yaml"));
    EXPECT_THAT(text, HasSubstr("$schema=")) << name;
    EXPECT_THAT(text, Not(HasSubstr("NAME"))) << name;
  }
  // The first command moves the rover: 5 s at 0.5 m/s.
  EXPECT_THAT(text_of_file(folder.file("out_yard/metrics.csv")), ContainsRegex("distance.travelled_m,2\\.[2-6]"));
  EXPECT_THAT(text_of_file(folder.file("out_pit/metrics.csv")), ContainsRegex("distance.travelled_m,2\\.[2-6]"));
}

TEST(New, TouchesNoFileThatIsThere) {
  const ScratchFolder folder;
  write_file(folder.file("yard.yaml"), "mine\n");
  const Ended ended = shoal_in(folder.file(""), "new vehicle yard");
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("yard.yaml: already exists"));
  EXPECT_EQ(text_of_file(folder.file("yard.yaml")), "mine\n");
  EXPECT_EQ(shoal_in(folder.file(""), "new world 'a b'").exit_code, 2);
  EXPECT_EQ(shoal_in(folder.file(""), "new").exit_code, 2);
}

TEST(New, NamesTheVehicleOfAWorldAfterItsFile) {
  const ScratchFolder folder;
  ASSERT_EQ(shoal_in(folder.file(""), "new vehicle digger").exit_code, 0);
  for (const auto& [vehicle, name] : {std::pair<std::string, std::string>{"digger.yaml", "digger1"},
                                      {"digger", "digger1"},
                                      {"remus100", "remus100_1"}}) {
    fs::remove(folder.file("pit.yaml"));
    ASSERT_EQ(shoal_in(folder.file(""), "new world pit --vehicle " + vehicle).exit_code, 0);
    const std::string text = text_of_file(folder.file("pit.yaml"));
    EXPECT_THAT(text, HasSubstr("- name: " + name + "\n    file: " + fs::path(vehicle).stem().string() + ".yaml\n"));
    EXPECT_THAT(text, Not(HasSubstr("rover1")));
  }
}

TEST(New, WritesProgramsOfTheNameAndForTheVehicle) {
  const ScratchFolder folder;
  EXPECT_EQ(shoal_in(folder.file(""), "new program helm --vehicle digger1").output,
            "helm/: written; `cmake -S helm -B helm/build` and `cmake --build helm/build` build it\n");
  const std::string text = text_of_file(folder.file("helm/helm.cpp"));
  EXPECT_THAT(text, testing::StartsWith("// Drives digger1 towards the wall"));
  EXPECT_THAT(text, HasSubstr("shoal::Client client(\"helm\")"));
  EXPECT_THAT(text, HasSubstr("\"digger1.drive.cmd\""));
  EXPECT_THAT(text_of_file(folder.file("helm/CMakeLists.txt")), HasSubstr("add_executable(helm helm.cpp)"));
  EXPECT_EQ(shoal_in(folder.file(""), "new program helm").exit_code, 4) << "it is there already";
}

TEST(New, WritesAPythonProgramThatFindsThePackage) {
  const ScratchFolder folder;
  const Ended ended = shoal_in(folder.file(""), "new program pilot --python");
  if (!fs::exists(fs::path(built("shoal")).parent_path() / "../lib/python/shoal/messages.pyi")) {  // with its module
    EXPECT_EQ(ended.exit_code, 4);
    EXPECT_THAT(ended.errors, HasSubstr("there is no Python package beside this program: `tools/build programs`"));
    GTEST_SKIP() << "built without Python";
  }
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const std::string text = text_of_file(folder.file("pilot.py"));
  EXPECT_THAT(text, ContainsRegex("\nimport sys\n\nsys.path.insert\\(0, \".*/lib/python\"\\)  # the Python package\n"));
  const std::string url = own_url();
  Program pilot({"env", "LCM_DEFAULT_URL=" + url, "/usr/bin/python3", folder.file("pilot.py")});
  const Ended run =
      run_shoal({"run", "minimal", "--duration", "15", "--speed", "max", "--await", "pilot", "--lcm-url", url});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(pilot.wait(), 0) << pilot.errors();
  EXPECT_THAT(pilot.errors(), ContainsRegex("the run is over, 0\\.[89][0-9]* m before the wall"));
}

void await_error(const Program& program, const std::string& text) {
  EXPECT_TRUE(await([&] { return program.errors().find(text) != std::string::npos; })) << program.errors();
}

TEST(Waiting, ProgramsAndCommandsSayAfterThreeSecondsForWhat) {
  const std::string url = own_url();
  Program rover({built("shoal-coop-rover"), "--name", "rover1", "--waypoints-m", "[[1,1]]", "--lcm-url", url,
                 "--join-timeout-s", "60"});
  Program spy({built("shoal"), "spy", "rover1.odometry", "--lcm-url", url, "--duration", "60"});
  Program control({built("shoal"), "control", "where", "--lcm-url", url, "--timeout", "60"});
  await_error(rover, "waits for a simulator to answer its join on 'sim.control.reply', at " + url);
  await_error(spy, "waiting for messages on 'rover1.odometry', at " + url);
  await_error(control, "waiting for a simulator to answer on 'sim.control.reply', at " + url);
}

TEST(Waiting, ARequestMayBeMadeBeforeTheRunHasStarted) {
  const std::string url = own_url();
  Program control({built("shoal"), "control", "quit", "--lcm-url", url, "--timeout", "120"});
  await_error(control, "waiting for a simulator to answer");
  Program run({built("shoal"), "run", "minimal", "--lcm-url", url, "--speed", "1", "--duration", "1000"});
  EXPECT_EQ(control.wait(), 0) << control.errors();
  EXPECT_EQ(control.output(), "ok\n");
  EXPECT_EQ(run.wait(), 0) << run.errors();
}

TEST(FileKinds, AreToldApartWithTheCommandForEach) {
  const ScratchFolder folder;
  const auto errors = [](const std::vector<std::string>& arguments) {
    const Ended ended = run_shoal(arguments);
    EXPECT_EQ(ended.exit_code, 2);
    return ended.errors;
  };
  const std::string study = source("worlds/studies/coop_land.yaml"), vehicle = source("vehicles/rover.yaml");
  EXPECT_EQ(errors({"run", study}), study + ": this is a study, not a world; `shoal study FILE` runs it\n");
  EXPECT_THAT(errors({"run", vehicle}), HasSubstr(": this is a vehicle, not a world; "));
  EXPECT_THAT(errors({"study", source("worlds/minimal.yaml")}), HasSubstr(": this is a world, not a study; "));
  EXPECT_THAT(errors({"run", "rover"}), HasSubstr("; 'rover' is a shipped vehicle\n"));

  write_file(folder.file("a.yaml"), "shoal: 1\nvehicles:\n  - {name: r, file: b.yaml}\n");
  write_file(folder.file("b.yaml"), "shoal: 1\nvehicles: []\n");
  EXPECT_EQ(errors({"check", folder.file("a.yaml")}),
            folder.file("a.yaml") + ":3:21: vehicle 'r': 'b.yaml' is a world, not a vehicle\n");
  write_file(folder.file("s.yaml"), "shoal: 1\nstudy: s\nworld: c.yaml\nseeds: 1-2\ncases: [{name: x}]\n");
  EXPECT_EQ(errors({"check", folder.file("s.yaml")}), folder.file("s.yaml") + ":3:8: 'world': there is no file '" +
                                                          folder.file("c.yaml") + "'; did you mean 'a.yaml'?\n");
}

TEST(New, WritesNoWorldThatItsVehicleDoesNotFit) {
  const ScratchFolder folder;
  const Ended ended =
      run_shoal({"new", "world", "bay", "--under-water", "--vehicle", "remus100.yaml", "--folder", folder.file("")});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("does not fit this world; such a world needs a vehicle with an autopilot: "));
  EXPECT_FALSE(std::filesystem::exists(folder.file("bay.yaml")));
}

}  // namespace
