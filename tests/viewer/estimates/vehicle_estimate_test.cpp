// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/vehicle_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/utime_t.hpp"
#include "sim/base/math.hpp"

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(VehicleEstimate, OfAnEstimateHasItsHeadingAndCovariance) {
  const shoal::estimate_t message{5, {1, 2, 3}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 0, 0}, std::numbers::pi / 2, 0};
  const auto estimate = viewer::read_estimate("any", shoal::encode(message));
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->utime, 5);
  EXPECT_EQ(estimate->position_m, sim::Vector3d(1, 2, 3));
  EXPECT_NEAR(sim::yaw_of(estimate->orientation.toRotationMatrix()), std::numbers::pi / 2, 1e-12);
  EXPECT_EQ((*estimate->covariance_m2)(0, 2), 3);  // row by row
}

TEST(VehicleEstimate, WithoutAHeadingIsTurnedByNothing) {
  const shoal::estimate_t message{5, {1, 2, 3}, {}, {0, 0, 0}, nan, 0};
  EXPECT_TRUE(viewer::read_estimate("any", shoal::encode(message))->orientation.isApprox(sim::Quaterniond::Identity()));
}

TEST(VehicleEstimate, APoseIsOneOnItsChannelOnly) {
  const shoal::pose_t pose{5, {1, 2, 3}, {0, 0, 0}, {2, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const auto estimate = viewer::read_estimate("rover1.estimate", shoal::encode(pose));
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->orientation.w(), 1, 1e-15);
  EXPECT_FALSE(estimate->covariance_m2);
  EXPECT_FALSE(viewer::read_estimate("rover1.goal", shoal::encode(pose)));
}

TEST(VehicleEstimate, NowhereIsNone) {
  const shoal::estimate_t message{5, {1, nan, 3}, {}, {0, 0, 0}, 0, 0};
  EXPECT_FALSE(viewer::read_estimate("any", shoal::encode(message)));
}

TEST(VehicleEstimate, OtherMessagesAreNoneAndDamagedOnesAreErrors) {
  EXPECT_FALSE(viewer::read_estimate("any", shoal::encode(shoal::utime_t{1})));
  EXPECT_FALSE(viewer::read_estimate("any", {}));
  auto damaged = shoal::encode(shoal::estimate_t{});
  damaged.pop_back();
  EXPECT_THROW(viewer::read_estimate("any", damaged), shoal::MessageError);
}

}  // namespace
