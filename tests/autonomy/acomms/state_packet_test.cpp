// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/state_packet.hpp"

#include <gtest/gtest.h>

namespace {

TEST(StatePacket, StateOfAnEstimateHasItsPositionAndCovariance) {
  Eigen::Matrix2d P;
  P << 4, -1.5, -1.5, 9;
  shoal::estimate_t estimate = autonomy::estimate_message(1000, {10, -20}, {0, 1.5}, P);
  autonomy::set_depth(estimate, 15);
  EXPECT_EQ(estimate.position_m[2], -15);
  EXPECT_DOUBLE_EQ(estimate.covariance_m2[8], 0.01);  // 0.1 m
  const autonomy::AcousticState state = autonomy::state_of(estimate, 7);
  EXPECT_EQ(state.sender, 7);
  EXPECT_EQ(state.depth_m, 15);
  EXPECT_EQ(autonomy::motion_of(state).p_W, autonomy::Vector2d(10, -20));
  EXPECT_TRUE(autonomy::covariance_of(state).isApprox(P, 1e-12)) << autonomy::covariance_of(state);
}

}  // namespace
