// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/placement.hpp"

#include <gtest/gtest.h>

namespace {

using sim::Vector3d;

using Pattern = sim::PlacementConfig::Pattern;

std::vector<sim::Pose> place(Pattern pattern, int count, double jitter_m = 0) {
  sim::PlacementConfig config;
  config.pattern = pattern;
  config.jitter_m = jitter_m;
  return sim::place_instances(config, count, sim::make_pose({10, 20, 0}, {0, 0, 0}), 1, "box");
}

TEST(Placement, AGridIsCenteredOnTheEntry) {
  const auto poses = place(Pattern::grid, 4);
  EXPECT_EQ(poses[0].translation(), Vector3d(9, 19, 0));
  EXPECT_EQ(poses[1].translation(), Vector3d(11, 19, 0));
  EXPECT_EQ(poses[3].translation(), Vector3d(11, 21, 0));
}

TEST(Placement, ACircleFacesOutwards) {
  const auto poses = place(Pattern::circle, 4);
  EXPECT_NEAR((poses[1].translation() - Vector3d(10, 30, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(sim::yaw_of(poses[1].linear()), std::numbers::pi / 2, 1e-12);
}

TEST(Placement, JitterStaysWithinItsBoundsAndIsEqualForEqualSeeds) {
  const auto plain = place(Pattern::grid, 100);
  const auto moved = place(Pattern::grid, 100, 0.4);
  const auto again = place(Pattern::grid, 100, 0.4);
  double largest = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Vector3d by = moved[i].translation() - plain[i].translation();
    largest = std::max(largest, by.cwiseAbs().maxCoeff());
    EXPECT_EQ(moved[i].translation(), again[i].translation());
  }
  EXPECT_LE(largest, 0.4);
  EXPECT_GT(largest, 0.35);
}

}  // namespace
