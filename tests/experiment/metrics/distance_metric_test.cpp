// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(Distance, IsTheLengthOfTheWay) {
  MetricWorld world(
      "  - {name: all, type: distance, vehicle: r1}\n"
      "  - {name: late, type: distance, vehicle: r1, from_s: 2}\n");
  world.drive(0.5);
  world.run_for(2);
  const double half_m = world.position_m().x() - 1;
  world.drive(-0.5);
  world.run_for(2);
  const double back_m = world.position_m().x() - 1;
  world.run_for(0.001);
  // Forth and back; while it brakes it still goes forth, so the way is longer than the two differences.
  EXPECT_GT(half_m, 0.8);
  EXPECT_GE(world.figure("all.travelled_m"), half_m + (half_m - back_m));
  EXPECT_LT(world.figure("all.travelled_m"), half_m + (half_m - back_m) + 0.3);
  EXPECT_NEAR(world.figure("late.travelled_m"), world.figure("all.travelled_m") - half_m, 0.01);
}

}  // namespace
