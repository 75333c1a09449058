// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/score/scoring.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/metrics/formation_metric_fixture.hpp"

namespace {

using namespace formation_metric_fixture;

TEST(Separation, IsTheSmallestDistanceOfTwoVehiclesAndItsTime) {
  TwoBoxes boxes("  - {name: apart, type: separation}\n");
  boxes.move("wing", {3, -4, 0});  // above the leader after 1 s
  boxes.run_for(2);
  EXPECT_NEAR(boxes.figure("apart.min_m"), 2, 1e-6);
  EXPECT_NEAR(boxes.figure("apart.at_s"), 1, 0.011);
}

TEST(Separation, OfASingleVehicleIsNone) {
  test::TestWorld test(test::box_world("        []\n", "{step_s: 0.01, gravity_mps2: 0}",
                                       "metrics: [{name: apart, type: separation}]\n"));
  experiment::Scoring scoring(test.world);
  test.world.step();
  scoring.after_step();
  EXPECT_TRUE(std::isnan(scoring.figures().at("apart.min_m")));
}

}  // namespace
