// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/bus/in_process_bus.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_checks.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/fidelity_files.hpp"
#include "verification/fidelity/fidelity.hpp"

namespace {

using namespace fidelity_files;

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(FidelityFiles, MistakesInThemAreNamed) {
  write("c.csv", header + row(0) + "0.1,1,2,3,0,0,oops,0,0,0,0,0,0,0\n");
  EXPECT_THAT(error_of(cases("")), HasSubstr("c.csv:3:1: case 'c': must have finite numbers, got 'oops'"));
  write("c.csv", header + row(0) + row(0.1234));
  EXPECT_THAT(error_of(cases("")),
              HasSubstr("c.csv: case 'c': a step of 0.005 s does not reach the row at t = 0.1234"));
  write("c.csv", header + row(0) + row(0.1));
  EXPECT_THAT(error_of(cases("    inputs: [{device: wheel, column: push}]\n")),
              HasSubstr("cases.yaml:5:14: case 'c': vehicle 'bluerov2': there is no device 'wheel'; devices: wrench"));
  EXPECT_THAT(
      error_of(cases("    inputs: [{device: wrench, message: shoal.wrench_t, fields: {force_N: [pull, 0, 0]}}]\n")),
      HasSubstr("c.csv:1:1: case 'c': there is no column 'pull'"));
  EXPECT_THAT(error_of(cases("    inputs: [{device: wrench}]\n")),
              HasSubstr("one of 'column' and 'fields' must be given"));
}

TEST_F(FidelityFiles, ErrorsAreAtTheLineOfTheCasesThatCausesThem) {
  write("c.csv", header + row(0) + row(0.1));
  EXPECT_THAT(error_of(cases("    world: {physics.foo: 3}\n")),
              AllOf(HasSubstr(folder_.file("cases.yaml") + ":5:13: case 'c': "), HasSubstr("unknown key 'foo'")));
  EXPECT_THAT(error_of(cases("    overrides: {bodies.frame.hydrodynamics.foo: 3}\n")),
              AllOf(HasSubstr(folder_.file("cases.yaml") + ":5:17: case 'c': vehicle 'bluerov2': body 'frame'"),
                    HasSubstr("unknown key 'foo'")));
  EXPECT_THAT(error_of(cases("    step_s: 50\n")), HasSubstr(folder_.file("cases.yaml") + ":6:13: case 'c': "));
  EXPECT_THAT(error_of(cases("", "nope.yaml")),
              HasSubstr(folder_.file("cases.yaml") + ":4:14: case 'c': there is no vehicle file '" +
                        folder_.file("nope.yaml")));
}

TEST_F(FidelityFiles, ErrorsOfOptionsNameTheOption) {
  write("c.csv", header + row(0) + row(0.1));
  EXPECT_THAT(error_of(cases(""), {.overrides = {{"a.b", "3"}}}),
              AllOf(StartsWith("--override a.b: case 'c': vehicle 'bluerov2': "), HasSubstr("unknown key 'a'")));
  EXPECT_THAT(error_of(cases(""), {.overrides = {{"devices.wrench.rate_hz", "fast"}}}),
              StartsWith("--override devices.wrench.rate_hz: case 'c': vehicle 'bluerov2': device 'wrench'"));
}

TEST_F(FidelityFiles, AMessageThatADeviceDoesNotTakeIsRefusedBeforeTheRun) {
  // The step does not meet the second row: who ran would say that.
  write("c.csv", header + row(0) + row(0.1234));
  EXPECT_THAT(error_of(cases("    inputs: [{device: wrench, column: push}]\n")),
              HasSubstr("cases.yaml:5:14: case 'c': vehicle 'bluerov2': device 'wrench': takes shoal.wrench_t, not "
                        "'shoal.actuator_command_t'"));
  EXPECT_THAT(error_of(cases("    inputs: [{device: wrench, message: shoal.nope_t, fields: {a: 1}}]\n")),
              HasSubstr("takes shoal.wrench_t, not 'shoal.nope_t'"));
}

TEST_F(FidelityFiles, ThereIsABottomFarBelowAndTheVehicleHasTheNameOfItsFile) {
  write("c.csv", header + row(0) + row(0.1));
  const verification::FidelityFile file = verification::read_fidelity_file(cases(""));
  const verification::FidelityCase& of = file.cases.front();
  const auto loaded =
      sim::load_world_tree(verification::fidelity_world(of, verification::read_fidelity_reference(of.reference)),
                           folder_.file("cases.yaml"));
  sim::InProcessBus bus;
  const sim::World world(loaded.config, bus);
  const sim::Vehicle& vehicle = *world.vehicles()[0];
  EXPECT_EQ(vehicle.name(), "bluerov2");
  sim::RayFilter others;
  others.exclude_group = vehicle.group();
  EXPECT_TRUE(world.scene().cast(vehicle.X_WV().translation(), -sim::Vector3d::UnitZ(), 12000, others));
}

}  // namespace
