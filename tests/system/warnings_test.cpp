// SPDX-License-Identifier: BSD-3-Clause
// What `shoal check` and `shoal run` warn of, as a user sees it.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "tests/system/shoal_program.hpp"

namespace {

using testing::HasSubstr;

TEST(Warnings, AreTheSameInCheckAndRun) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("odd.yaml");
  system_test::write_file(file,
                          "shoal: 1\nphysics: {step_s: 0.01}\nrun: {duration_s: 0.1}\n"
                          "objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
                          "vehicles:\n"
                          "  - name: v1\n"
                          "    position_m: [0, 0, 0.2]\n"
                          "    model:\n"
                          "      shoal: 1\n"
                          "      vehicle: ball\n"
                          "      bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 1}]}]\n"
                          "      devices: [{name: imu, type: imu, rate_hz: 300}]\n");
  const std::string rate = file + ":12:49: vehicle 'v1': device 'imu': 'rate_hz' of 300 Hz is above the step rate";
  const std::string start = file + ":6:5: vehicle 'v1': it starts 0.3 m deep in 'ground'";
  const system_test::Ended check = system_test::run_shoal({"check", file});
  const system_test::Ended run = system_test::run_shoal({"run", file, "--bus", "none", "--quiet"});
  for (const system_test::Ended* ended : {&check, &run}) {
    EXPECT_EQ(ended->exit_code, 0);
    EXPECT_THAT(ended->errors, HasSubstr("warning: " + rate));
    EXPECT_THAT(ended->errors, HasSubstr("warning: " + start));
    EXPECT_EQ(std::count(ended->errors.begin(), ended->errors.end(), '\n'), 2) << ended->errors;
  }
}

TEST(Notes, SayAtWhichSpeedAVehicleTurnsOverAndWhatHoldsIt) {
  const system_test::Ended bare = system_test::run_shoal({"check", "bluerov2_heavy"});
  EXPECT_EQ(bare.exit_code, 0);
  EXPECT_EQ(bare.errors, "");
  EXPECT_THAT(bare.output, HasSubstr("note: vehicle 'bluerov2_heavy': nothing keeps it level: above 0.33 m/s ahead"));
  EXPECT_THAT(bare.output, HasSubstr("bluerov2_station has an autopilot"));
  const system_test::Ended held = system_test::run_shoal({"check", "bluerov2_station"});
  EXPECT_EQ(held.errors, "");
  EXPECT_THAT(held.output, HasSubstr("device 'autopilot': it holds the vehicle level up to 0.92 m/s ahead"));
  const system_test::Ended world = system_test::run_shoal({"check", "rov_station"});
  EXPECT_THAT(world.output, HasSubstr("device 'autopilot': it holds the vehicle level up to 0.92 m/s ahead"));
  const system_test::Ended weak = system_test::run_shoal(
      {"check", "rov_station", "--set", "vehicles.rov.devices.autopilot.gains.attitude.bandwidth_radps=1.2"});
  EXPECT_THAT(weak.errors, HasSubstr("up to 0.39 m/s ahead"));
  EXPECT_THAT(weak.errors, HasSubstr("the Munk moment of the added mass turns it over"));
}

TEST(Warnings, NameAProgramThatIsNotThere) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("programs.yaml");
  system_test::write_file(file,
                          "shoal: 1\nprocesses: [{name: p, command: [shoal-coop-submarine]}, {name: q, command: "
                          "[shoal-coop-rover, --name, q]}]\n");
  const system_test::Ended check = system_test::run_shoal({"check", file});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_EQ(check.errors, "warning: " + file +
                              ":2:33: process 'p': there is no program 'shoal-coop-submarine' beside "
                              "shoal or in PATH\nwarning: " +
                              file +
                              ":2:77: process 'q': the arguments in 'command' are not checked; those of 'program: "
                              "shoal-coop-rover' with 'args:' are, by its declaration\n");
}

TEST(CheckPrograms, WrongArgumentsAreFoundByCheckAndRun) {
  const system_test::ScratchFolder folder;
  const std::string file = folder.file("world.yaml");
  system_test::write_file(file,
                          "shoal: 1\nprocesses:\n  - {name: rover1, program: shoal-coop-rover, args: {name: rover1, "
                          "waypoints_m: [[1, 2], [3]]}}\n");
  const std::string error = file +
                            ":3:90: process 'rover1': program 'shoal-coop-rover': 'waypoints_m[2]' must be 2 numbers, "
                            "got 1";
  for (const char* command : {"check", "run"}) {
    const system_test::Ended ended = system_test::run_shoal({command, file});
    EXPECT_EQ(ended.exit_code, 2) << command;
    EXPECT_THAT(ended.errors, testing::HasSubstr(error)) << command;
  }
  EXPECT_EQ(system_test::run_shoal({"check", file, "--set", "processes.rover1.args.waypoints_m=[[1, 2]]"}).exit_code,
            0);
}

TEST(CheckPrograms, StartsNoProgram) {
  const system_test::ScratchFolder folder;
  const std::string program = folder.file("pilot"), mark = folder.file("started");
  system_test::write_file(program, "#!/bin/sh\ntouch " + mark + "\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  system_test::write_file(program + ".args.yaml", "shoal_args: 1\nprogram: pilot\nargs: [{name: a, type: number}]\n");
  const std::string file = folder.file("world.yaml");
  system_test::write_file(file, "shoal: 1\nprocesses: [{name: p, program: " + program + ", args: {a: 1}}]\n");
  const system_test::Ended check = system_test::run_shoal({"check", file});
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  EXPECT_EQ(check.errors, "");
  EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST(CheckPrograms, AProgramGetsItsArgumentsAsWords) {
  const system_test::ScratchFolder folder;
  const std::string program = folder.file("bin/pilot"), results = folder.file("out");
  std::filesystem::create_directory(folder.file("bin"));
  system_test::write_file(program, "#!/bin/sh\nprintf '%s\\n' \"$@\"\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  system_test::write_file(program + ".args.yaml",
                          "shoal_args: 1\nprogram: pilot\nargs:\n  - {name: run_name, type: text}\n  - {name: start_m, "
                          "type: tuple, columns: [x, y]}\n  - {name: loop, type: flag}\n");
  const std::string file = folder.file("world.yaml");
  system_test::write_file(file,
                          "shoal: 1\nprocesses: [{name: p, program: pilot, args: {run_name: 'a {run}', start_m: [1, "
                          "2.50], loop: true}}]\n");
  // --allow-path is where its program may be, too.
  const system_test::Ended ended = system_test::run_shoal(
      {"run", file, "--launch", "--run-name", "seven", "--duration", "1", "--speed", "1", "--lcm-url",
       system_test::own_url(), "--results", results, "--no-plots", "--allow-path", folder.file("bin")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_EQ(system_test::text_of_file(results + "/p.log"), "--run-name=a seven\n--start-m=[1,2.5]\n--loop\n");
}

TEST(CheckPrograms, ADeclarationIsCheckedToo) {
  const system_test::ScratchFolder folder;
  const std::string file = folder.file("pilot.args.yaml");
  system_test::write_file(file, "shoal_args: 1\nprogram: pilot\nargs: [{name: a, type: numbr}]\n");
  const system_test::Ended wrong = system_test::run_shoal({"check", file});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.errors, testing::HasSubstr(file + ":3:24: argument 'a': 'type' must be one of"));
  const system_test::Ended good =
      system_test::run_shoal({"check", system_test::source("examples/python/coop_auv.py.args.yaml")});
  EXPECT_EQ(good.exit_code, 0) << good.errors;
  EXPECT_THAT(good.output, testing::HasSubstr("declaration of program 'coop_auv.py': 3 arguments"));
}

TEST(Warnings, ReportAtTheEndOfAMetricThatReceivedNothing) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("mute.yaml");
  system_test::write_file(
      file, system_test::endless_world(
                "metrics: [{name: error, type: position_error, vehicle: rover1, channel: rover1.estimate}]\n"));
  const system_test::Ended run =
      system_test::run_shoal({"run", file, "--bus", "none", "--duration", "1", "--speed", "max"});
  EXPECT_THAT(run.errors,
              HasSubstr("metric 'error': no estimate was received on 'rover1.estimate': its figures are not numbers"));
}

TEST(Warnings, AreSaidOnceForAllCopiesOfAVehicle) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("copies.yaml");
  // Of 10 kg and 0.01 m^3: 2/5 m r^2 = 0.0714 kg m^2; and a raft that is too light for the step.
  system_test::write_file(scratch.file("fish.yaml"),
                          "shoal: 1\nvehicle: fish\nbodies:\n  - name: hull\n    parts: [{shape: sphere, radius_m: "
                          "0.1, mass_kg: 10}]\n    hydrodynamics: {frame: frd, mass_kg: 10, inertia_kgm2: [0.001, "
                          "0.001, 0.001], added_mass: [5, 5, 5, 1, 1, 1], linear_damping: [1, 1, 1, 1, 1, 1]}\n");
  system_test::write_file(scratch.file("raft.yaml"),
                          "shoal: 1\nvehicle: raft\nbodies: [{name: hull, parts: [{shape: box, size_m: [1, 1, 0.1], "
                          "mass_kg: 0.1}]}]\n");
  std::string world = "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}}\nvehicles:\n";
  for (int i = 0; i < 3; ++i)
    for (const char* kind : {"fish", "raft"})
      world += "  - {name: " + (kind + std::to_string(i)) + ", file: " + kind + ".yaml, position_m: [" +
               std::to_string(5 * i) + ", " + (kind[0] == 'f' ? "0, -3" : "5, 0") + "]}\n";
  system_test::write_file(file, world);
  const system_test::Ended check = system_test::run_shoal({"check", file});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_THAT(check.errors, HasSubstr("body 'fish0/hull': the mean of its moments of inertia is 0.001 kg m^2"));
  EXPECT_THAT(check.errors, HasSubstr("body 'raft0/hull': it is so light that it oscillates in the water"));
  EXPECT_EQ(std::count(check.errors.begin(), check.errors.end(), '\n'), 2) << check.errors;
}

TEST(Warnings, OfTheEndAreInTheSummary) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("deep.yaml");
  system_test::write_file(
      file,
      "shoal: 1\nphysics: {step_s: 0.1}\nrun: {duration_s: 70}\nmedium: {water: {}}\nvehicles:\n  - {name: auv, "
      "position_m: [0, 0, -10], model: {shoal: 1, vehicle: ball, bodies: [{name: hull, parts: [{shape: sphere, "
      "density_kgpm3: 1030}]}], devices: [{name: dvl, type: dvl, phase_s: 0}]}}\n");
  const system_test::Ended run =
      system_test::run_shoal({"run", file, "--bus", "none", "--speed", "max", "--results", scratch.file("out")});
  const std::string line = "device 'auv/dvl': no bottom lock in 69.8 s";
  EXPECT_THAT(run.errors, HasSubstr("warning: " + line));
  EXPECT_THAT(system_test::text_of_file(scratch.file("out") + "/summary.json"), HasSubstr("\"" + line + "\""));
}

TEST(Warnings, ReportAFirstContactWhileTheWorldRuns) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("fall.yaml");
  system_test::write_file(
      file,
      "shoal: 1\nphysics: {step_s: 0.01}\nrun: {duration_s: 2}\n"
      "objects: [{name: rock, fixed: true, parts: [{shape: box}]}]\n"
      "vehicles:\n"
      "  - {name: auv4, position_m: [0, 0, 5.905], model: {shoal: 1, vehicle: ball, bodies: [{name: "
      "hull, parts: [{shape: sphere, mass_kg: 1}]}]}}\n");
  const system_test::Ended run =
      system_test::run_shoal({"run", file, "--bus", "none", "--results", scratch.file("out")});
  // It falls 4.905 m.
  EXPECT_THAT(run.errors, HasSubstr("1.0 s: auv4 hits rock"));
  EXPECT_THAT(run.output, HasSubstr("auv4 hit rock: "));
  EXPECT_THAT(system_test::text_of_file(scratch.file("out") + "/summary.json"), HasSubstr("\"with\": \"rock\""));
}

}  // namespace
