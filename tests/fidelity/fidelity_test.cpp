// SPDX-License-Identifier: BSD-3-Clause
#include "verification/fidelity/fidelity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sim/config/diagnostics.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

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

}  // namespace
