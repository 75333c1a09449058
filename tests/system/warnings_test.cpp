// SPDX-License-Identifier: BSD-3-Clause
// What `shoal check` and `shoal run` warn of, as a user sees it.
#include <gmock/gmock.h>

#include <algorithm>

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
  const std::string rate = file + ":12:49: vehicle 'v1': device 'imu': 'rate_hz' of 300 Hz is above that of the steps";
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
                              "shoal or in PATH\n");
}

TEST(Warnings, TellAtTheEndOfAMetricThatHeardNothing) {
  const system_test::ScratchFolder scratch;
  const std::string file = scratch.file("mute.yaml");
  system_test::write_file(
      file, system_test::endless_world(
                "metrics: [{name: error, type: position_error, vehicle: rover1, channel: rover1.estimate}]\n"));
  const system_test::Ended run =
      system_test::run_shoal({"run", file, "--bus", "none", "--duration", "1", "--speed", "max"});
  EXPECT_THAT(run.errors,
              HasSubstr("metric 'error': no estimate came on 'rover1.estimate': its figures are not numbers"));
}

TEST(Warnings, TellOfAFirstContactWhileTheWorldRuns) {
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
