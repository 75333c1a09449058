// SPDX-License-Identifier: BSD-3-Clause
#include "verification/fidelity/fidelity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "sim/bus/in_process_bus.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/bottom_check.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "verification/fidelity/fidelity_report.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string cases_file = test_support::source_path("tests/fidelity/cases.yaml");

verification::FidelityResult run(const std::string& name, const verification::FidelityOptions& options = {}) {
  const verification::FidelityFile file = verification::read_fidelity_file(cases_file);
  const auto found =
      std::find_if(file.cases.begin(), file.cases.end(), [&](const auto& of) { return of.name == name; });
  if (found == file.cases.end()) throw std::runtime_error("no case " + name);
  return verification::run_fidelity_case(*found, options);
}

/// The bars that Shoal has set itself, by the group of the case or its name: what is in the file may be tighter, not
/// looser.
double bar_of_position_m(const std::string& name) {
  static const std::map<std::string, double> of_cases{
      {"remus100_turn", 1e-3},      {"remus100_zigzag", 0.025},
      {"remus100_decay", 5e-4},     {"remus100_current_relinflow", 5e-5},
      {"otter_decay", 2e-5},        {"otter_payload", 8e-4},
      {"otter_current", 8e-5},      {"prestero_decay", 1.5e-5},
      {"own_remus100_limits", 4e-3}};
  static const std::map<std::string, double> of_groups{{"remus100", 1.5e-5}, {"otter", 3e-6},      {"prestero", 3e-6},
                                                       {"bluerov2h", 8e-7},  {"bluerov2wu", 8e-7}, {"own", 2e-4}};
  if (const auto one = of_cases.find(name); one != of_cases.end()) return one->second;
  return of_groups.at(name.substr(0, name.find('_')));
}

TEST(Fidelity, NoBarIsLooserThanItWasSet) {
  const double any = std::numeric_limits<double>::infinity();
  for (const verification::FidelityCase& of : verification::read_fidelity_file(cases_file).cases) {
    EXPECT_LE(of.bars.position_rms_m.value_or(any), bar_of_position_m(of.name)) << of.name;
    EXPECT_LE(of.bars.position_max_m.value_or(any), 3 * bar_of_position_m(of.name) + 3e-4) << of.name;
    EXPECT_LE(of.bars.velocity_rms_mps.value_or(any), 4e-4) << of.name;
    EXPECT_LE(of.bars.turn_rms_degps.value_or(any), 0.05) << of.name;
    EXPECT_LE(of.bars.heading_rms_deg.value_or(any), 0.02) << of.name;
  }
}

TEST(Fidelity, EveryTrajectoryKeepsItsBarsAtStepZero) {
  const verification::FidelityFile file = verification::read_fidelity_file(cases_file);
  EXPECT_EQ(file.cases.size(), 41u);
  for (const verification::FidelityCase& of : file.cases) {
    const verification::FidelityResult result = verification::run_fidelity_case(of);
    EXPECT_LE(of.step_s, 0.005);
    EXPECT_EQ(result.step_s, 0);
    EXPECT_THAT(result.missed, testing::IsEmpty()) << of.name;
  }
}

TEST(Fidelity, AtStepZeroTheErrorOfTheStepIsGone) {
  const verification::FidelityResult coarse = run("bluerov2wu_ascent", {.step_s = 0.005}),
                                     zero = run("bluerov2wu_ascent");
  EXPECT_EQ(coarse.step_s, 0.005);
  EXPECT_GT(coarse.position_rms_m, 100 * zero.position_rms_m);
  EXPECT_GT(coarse.turn_rms_degps, 100 * zero.turn_rms_degps);
}

TEST(Fidelity, ARunUntilABarIsMissedEndsThere) {
  verification::FidelityOptions options{.overrides = {{"bodies.hull.hydrodynamics.mass_kg", "56"}}};
  const verification::FidelityResult whole = run("otter_turn", options);
  options.until_missed = true;
  const verification::FidelityResult part = run("otter_turn", options);
  EXPECT_THAT(part.missed, testing::SizeIs(testing::Ge(1u)));
  EXPECT_LT(part.t.size(), whole.t.size() / 2);
  // The rows that are left out count as equal.
  EXPECT_LT(part.position_rms_m, whole.position_rms_m);
}

TEST(Fidelity, SmallErrorsThatWereOnceWithinTheBarsAreSeen) {
  const std::string added = "bodies.hull.hydrodynamics.added_mass";
  // A22 of REMUS less by 5 %, A66 of the Otter more by 5 %.
  EXPECT_THAT(run("remus100_turn", {.overrides = {{added,
                                                   "[0.86330184, 28.77892523, 30.29360551, 0.03524912, "
                                                   "3.59385625, 3.59385625]"}}})
                  .missed,
              testing::Not(testing::IsEmpty()));
  EXPECT_THAT(run("otter_turn", {.overrides = {{added, "[5.28152101, 82.5, 55, 2.052864, 11, 24.54375]"}}}).missed,
              testing::Not(testing::IsEmpty()));
}

/// Root mean square of the distances between two runs of a case.
double rms_between_m(const verification::FidelityResult& a, const verification::FidelityResult& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.ours.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) sum += std::pow(a.ours[i][axis] - b.ours[i][axis], 2);
  return std::sqrt(sum / static_cast<double>(a.ours.size()));
}

TEST(Fidelity, TheStepIsOfSecondOrder) {
  // Richardson's estimate from our own runs, so that what the references round does not count.
  for (const verification::FidelityCase& of : verification::read_fidelity_file(cases_file).cases) {
    if (of.group.starts_with("own_")) continue;  // with waves, dead bands and tables
    verification::FidelityOptions options;
    // Without the jump of the drag coefficient of REMUS, and the corners of its table.
    if (of.group == "remus100") options.overrides["bodies.hull.hydrodynamics.cross_flow.drag_coefficient"] = "[0.8]";
    const auto with_step = [&](double step_s) {
      options.step_s = step_s;
      return verification::run_fidelity_case(of, options);
    };
    const verification::FidelityResult coarse = with_step(0.0025), half = with_step(0.00125),
                                       quarter = with_step(0.000625);
    const double order = std::log2(rms_between_m(coarse, half) / rms_between_m(half, quarter));
    EXPECT_GT(order, 1.8) << of.name;
    if (of.name == "remus100_attitude_release") continue;  // its terms of second order nearly cancel
    EXPECT_LT(order, 2.2) << of.name;
  }
}

TEST(Fidelity, TwentyMillisecondsAreEnough) {
  // The references of MSS were integrated with this step by RK4; that of the zigzag jumps.
  for (const verification::FidelityCase& of : verification::read_fidelity_file(cases_file).cases) {
    if (of.group.starts_with("own_")) continue;
    const double bar_m = of.name == "remus100_zigzag" ? 0.05 : of.group == "prestero" ? 0.1 : 0.02;
    EXPECT_LE(verification::run_fidelity_case(of, {.step_s = 0.02}).position_rms_m, bar_m) << of.name;
  }
}

const std::string hull = "bodies.hull.hydrodynamics.";

TEST(Fidelity, WithoutAddedMassAnOtterMissesItsBarByMeters) {
  const verification::FidelityOptions none{.overrides = {{hull + "added_mass", "[0, 0, 0, 0, 0, 0]"}}};
  // The references' own figures: 16 m rms in the turn, 53 m in the current.
  EXPECT_NEAR(run("otter_turn", none).position_rms_m, 16, 2);
  EXPECT_GT(run("otter_current", none).position_rms_m, 10);
}

TEST(Fidelity, WithoutCoriolisForcesOfAddedMassAnOtterMissesItsBarByMeters) {
  const verification::FidelityOptions none{.overrides = {{hull + "quirks.added_mass_coriolis", "none"}}};
  EXPECT_NEAR(run("otter_turn", none).position_rms_m, 16, 2);
  EXPECT_GT(run("otter_current", none).position_rms_m, 10);
}

TEST(Fidelity, WithoutAddedMassARemusMissesItsBar) {
  const verification::FidelityOptions none{.overrides = {{hull + "added_mass", "[0, 0, 0, 0, 0, 0]"}}};
  const verification::FidelityResult result = run("remus100_turn", none);
  EXPECT_THAT(result.missed, testing::Not(testing::IsEmpty()));
  EXPECT_GT(result.position_rms_m, 0.3);
}

TEST(Fidelity, WhatAReferenceDoesInItsOwnWayIsSeen) {
  // README figures: the true integral differs by 6.6 m rms in remus100_turn, by 0.84 m in otter_turn.
  EXPECT_NEAR(run("remus100_turn", {.overrides = {{hull + "cross_flow.strips", "exact"}}}).position_rms_m, 6.6, 0.2);
  EXPECT_NEAR(run("otter_turn", {.overrides = {{hull + "cross_flow.strips", "exact"}}}).position_rms_m, 0.84, 0.1);
  // Thrust by speed over ground: 10.6 m after 100 s.
  const verification::FidelityResult inflow =
      run("remus100_current", {.overrides = {{"devices.propeller.inflow", "water_speed"}}});
  EXPECT_NEAR(inflow.position_max_m, 10.6, 0.5);
}

class FidelityFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  std::string error_of(const std::string& file, const verification::FidelityOptions& options = {}) {
    try {
      for (const verification::FidelityCase& of : verification::read_fidelity_file(file).cases)
        verification::run_fidelity_case(of, options);
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
    return {};
  }
  std::string cases(const std::string& more,
                    const std::string& vehicle = test_support::source_path("vehicles/bluerov2.yaml")) {
    return write("cases.yaml", "shoal: 1\ngroups:\n  - name: g\n    vehicle: " + vehicle + "\n" + more +
                                   "    cases: [{name: c, reference: c.csv}]\n");
  }
  const std::string header = "t[s],x,y,z,phi,theta,psi,u,v,w,p,q,r,push\n";
  /// At rest at a place.
  static std::string row(double t) { return sim::number_text(t) + ",1,2,3,0,0,0.5,0,0,0,0,0,0,0\n"; }
  test_support::ScratchFolder folder_;
};

TEST_F(FidelityFiles, ATrajectoryOfOnesOwnIsComparedWithItsStart) {
  write("c.csv", header + "0,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n0.1,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n");
  const std::string file = cases("    bars: {position_max_m: 1e-9}\n");
  const verification::FidelityResult result =
      verification::run_fidelity_case(verification::read_fidelity_file(file).cases.front());
  EXPECT_NEAR(result.ours.front()[0], 1, 1e-12);
  EXPECT_NEAR(result.ours.front()[2], 3, 1e-12);
  EXPECT_NEAR(result.ours.front()[5], 0.5, 1e-12);
  // 2 N up on 11.5 kg and 14.57 kg of added mass, for 0.1 s.
  EXPECT_NEAR(result.ours.back()[2] - 3, -2 / 26.07 * 0.01 / 2, 0.1 * 2 / 26.07 * 0.01 / 2);
  EXPECT_THAT(result.missed, testing::ElementsAre(testing::StartsWith("position_max_m ")));
}

TEST_F(FidelityFiles, TheReportHasTheTableTheImagesAndOurStates) {
  write("c.csv", header + "0,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n0.1,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n");
  const verification::FidelityFile file = verification::read_fidelity_file(cases("    title: Mine\n"));
  verification::write_fidelity_report(folder_.file("report"), "A word before.\n",
                                      {verification::run_fidelity_case(file.cases.front())}, true);
  const auto read = [&](const std::string& name) {
    std::ifstream in(folder_.file("report/" + name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_THAT(read("fidelity.md"), AllOf(HasSubstr("A word before."), HasSubstr("## Mine"),
                                         HasSubstr("![c](fidelity/c.png)"), HasSubstr("| north (m) | 1.0000 |")));
  EXPECT_THAT(read("fidelity/c.png"), testing::StartsWith("\x89PNG"));
  EXPECT_THAT(read("fidelity/c.csv"), testing::StartsWith("t,x,y,z,phi,theta,psi,u,v,w,p,q,r\n0,1,2,3,0,0,0.5,"));
}

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

TEST_F(FidelityFiles, AReferenceMustBeATrackOfTwoRowsOrMore) {
  const auto error_with = [&](const std::string& text) {
    write("c.csv", text);
    return error_of(cases(""));
  };
  EXPECT_THAT(error_of(cases("")), HasSubstr("c.csv: case 'c': does not exist"));
  EXPECT_THAT(error_with(""), HasSubstr("c.csv: case 'c': is empty"));
  EXPECT_THAT(error_with(header), HasSubstr("c.csv: case 'c': must have two rows of numbers or more, has 0"));
  EXPECT_THAT(error_with(header + row(0)), HasSubstr("c.csv: case 'c': must have two rows of numbers or more, has 1"));
  EXPECT_THAT(error_with(header + row(0) + row(0.2) + row(0.1)),
              HasSubstr("c.csv:4:1: case 'c': the time must rise, got 0.1 after 0.2"));
  EXPECT_THAT(error_with(header + row(0.1) + row(0.2)),
              HasSubstr("c.csv:2:1: case 'c': the first row must be at t = 0, got 0.1"));
  EXPECT_THAT(error_with(header + row(0) + "0.1,1e308,2,3,0,0,0.5,0,0,0,0,0,0,0\n"),
              HasSubstr("c.csv:3:1: case 'c': must have numbers from -1e9 to 1e9, got 1e308"));
  EXPECT_THAT(error_with("x,y\n0,1\n"), HasSubstr("c.csv:1:1: case 'c': the first column must be t, got 'x'"));
  EXPECT_EQ(error_with(header + row(0) + row(0.1)), "");
}

TEST_F(FidelityFiles, ADirectoryIsNoReference) {
  std::filesystem::create_directory(folder_.file("c.csv"));
  EXPECT_THAT(error_of(cases("")), HasSubstr("c.csv: case 'c': is not a file"));
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

TEST_F(FidelityFiles, ALineReportsHowACaseWent) {
  verification::FidelityResult result;
  result.of.name = "turn";
  result.position_rms_m = 0.03125;
  EXPECT_EQ(verification::fidelity_line(result, 2, 24), "2 of 24: turn: position rms 0.0312 m");
  result.missed = {"position_rms_m 0.03125 > 0.01"};
  EXPECT_EQ(verification::fidelity_line(result, 2, 24), "2 of 24: turn: position rms 0.0312 m, bars missed: 1");
}

}  // namespace
