// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiment/score/link_counts.hpp"
#include "experiment/score/metric.hpp"
#include "experiment/score/scoring.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A box that turns about its y axis at 1 rad/s, its nose going down, without gravity.
TEST(Tilt, ReportsMeanSpreadAndFallOfASteadyTurn) {
  test::TestWorld test(test::box_world(
      "        - {name: clock, type: clock}\n", "{step_s: 0.001, gravity_mps2: 0}",
      "metrics:\n  - {name: all, type: tilt, vehicle: r1}\n  - {name: late, type: tilt, vehicle: r1, from_s: 5}\n"));
  experiment::Scoring scoring(test.world);
  sim::Body& body = *test.world.find_vehicle("r1")->bodies().front().second;
  body.set_velocity_W({0, 0, 0}, {0, 1, 0});
  for (int step = 0; step < 1000; ++step) {
    test.world.step();
    scoring.after_step();
  }
  const auto figures = scoring.figures();
  constexpr double degrees = 180 / std::numbers::pi;
  // Leans from 0 to 1 rad, evenly: the mean is 1/2, the spread 1 / sqrt(12); 0.1 %: the steps, and a turn in steps.
  EXPECT_NEAR(figures.at("all.pitch_mean_deg"), 0.5 * degrees, 1e-3 * degrees);
  EXPECT_NEAR(figures.at("all.pitch_std_deg"), degrees / std::sqrt(12), 1e-3 * degrees);
  EXPECT_NEAR(figures.at("all.max_deg"), degrees, 1e-3 * degrees);
  EXPECT_NEAR(figures.at("all.fell_s"), std::numbers::pi / 4, 2e-3);
  for (const char* figure : {"pitch_mean_deg", "pitch_std_deg", "max_deg", "fell_s"})
    EXPECT_TRUE(std::isnan(figures.at(std::string("late.") + figure))) << figure;
}

}  // namespace
