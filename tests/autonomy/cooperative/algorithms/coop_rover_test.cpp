// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::nav_second;
using test::nav_setup;
using test::started;

/// A rover that has driven 10 m east.
std::unique_ptr<Estimator> driven_rover() {
  auto rover = started("coop_rover", nav_setup(2, 0, {5, 0}, 0.1));
  for (int i = 1; i <= 10; ++i) rover->predict(i * nav_second, {1, 0}, 100 * Matrix2::Identity());
  return rover;
}

TEST(CoopRoverFilter, HasTheErrorsOfOdometryOfTheProgram) {
  const Estimate estimate = driven_rover()->now(10.5 * nav_second);
  EXPECT_NEAR(estimate.p_W.x(), 5 + 10.5, 1e-9);
  EXPECT_NEAR(estimate.P(0, 0), 0.1 * 0.1 + 0.03 * 0.03 * 10, 1e-9);
  // Across: slip, and the random walk of the heading over the rest of each way, m^2: 0.015^2 (9^2 + ... + 1).
  EXPECT_NEAR(estimate.P(1, 1), 0.1 * 0.1 + 0.01 * 0.01 * 10 + 0.015 * 0.015 * 285, 1e-9);
}

TEST(CoopRoverFilter, UsesASightFromItsHeading) {
  const auto rover = driven_rover();
  const auto other = started("naive", nav_setup(2, 1, {15, 4}, 0.2));
  const Bytes payload = other->make_payload(0, 100);
  Relative seen;
  seen.time = 10 * nav_second;
  seen.other = 1;
  seen.range_m = 4.1;  // north of it, 0.1 m too far
  seen.bearing_rad = std::numbers::pi / 2;
  seen.range_std_m = 0.1;
  seen.payload = payload;
  rover->on_bearing(seen);
  // Across, as above, with the error of the heading, 0.015^2 (9 + ... + 1), which a relative measurement from 4 m away
  // shows along.
  const double R = 0.2 * 0.2 + 0.1 * 0.1, across = 0.1 * 0.1 + 0.01 * 0.01 * 10 + 0.015 * 0.015 * 285;
  const double both = 4 * 0.015 * 0.015 * 45;
  const double along = 0.1 * 0.1 + 0.03 * 0.03 * 10 + 4 * 4 * 0.015 * 0.015 * 10 + R;
  const double gain = (across * along - both * both) / (along * (across + R) - both * both);
  EXPECT_NEAR(rover->now(10 * nav_second).p_W.y(), -0.1 * gain, 1e-6);
}

TEST(CoopRoverFilter, SendsItsPositionWithGpsOnlyAndNotBetterThanAFix) {
  const auto rover = driven_rover();
  EXPECT_TRUE(rover->make_payload(10 * nav_second, 100).empty());
  rover->fix(10 * nav_second, {15, 0}, 0.5);
  const auto sent = position_in(rover->make_payload(10 * nav_second, 100));
  ASSERT_TRUE(sent);
  EXPECT_NEAR(sent->P(0, 0), 0.5 * 0.5, 1e-9);
  EXPECT_NEAR(sent->P(1, 1), 0.5 * 0.5, 1e-9);
}

TEST(CoopRoverFilter, UsesFixesBeforeItMoves) {
  const auto rover = started("coop_rover", nav_setup(2, 0, {0, 0}, 1));
  rover->fix(0, {3, 0}, 1);
  const Estimate estimate = rover->now(0);  // K = 1 / 2
  EXPECT_NEAR(estimate.p_W.x(), 1.5, 1e-12);
  EXPECT_NEAR(estimate.P(0, 0), 0.5, 1e-12);
}

}  // namespace
