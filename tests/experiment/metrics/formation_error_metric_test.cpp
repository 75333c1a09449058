// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "tests/experiment/metrics/formation_metric_fixture.hpp"

namespace {

using namespace formation_metric_fixture;

TEST(FormationError, IsTheHorizontalDistanceFromThePlaceByTheCourseOfTheLeader) {
  TwoBoxes boxes(
      "  - {name: there, type: formation_error, vehicle: wing, leader: r1, offset_m: [4, 3]}\n"
      "  - {name: off, type: formation_error, vehicle: wing, leader: r1, offset_m: [0, 0]}\n");
  // Northwards: 4 m ahead is north, 3 m to the left is west.
  boxes.move("r1", {0, 1, 0});
  boxes.move("wing", {0, 1, 0});
  boxes.run_for(1);
  EXPECT_NEAR(boxes.figure("there.max_m"), 0, 1e-9);
  EXPECT_NEAR(boxes.figure("off.rms_m"), 5, 1e-9);  // 3-4-5; the height does not count
  EXPECT_NEAR(boxes.figure("off.final_m"), 5, 1e-9);
}

TEST(FormationError, OfALeaderThatStandsIsByItsBow) {
  TwoBoxes boxes("  - {name: bow, type: formation_error, vehicle: wing, leader: r1, offset_m: [-3, 4]}\n");
  boxes.run_for(0.1);
  EXPECT_NEAR(boxes.figure("bow.max_m"), 0, 1e-9);
}

TEST(FormationError, IsTheRootOfTheMeanSquare) {
  TwoBoxes boxes(
      "  - {name: rms, type: formation_error, vehicle: wing, leader: r1, offset_m: [-3, 4], from_s: 0.505}\n");
  // The leader moves away at 1 m/s: the error of step k is 0.01 k, from step 51 to 100.
  boxes.move("r1", {1, 0, 0});
  boxes.run_for(1);
  double sum_m2 = 0;
  for (int k = 51; k <= 100; ++k) sum_m2 += 1e-4 * k * k;
  EXPECT_NEAR(boxes.figure("rms.rms_m"), std::sqrt(sum_m2 / 50), 1e-9);
  EXPECT_NEAR(boxes.figure("rms.max_m"), 1, 1e-9);
}

}  // namespace
