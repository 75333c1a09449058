// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiment;

TEST(Interval, QuantilesOfStudentAreThoseOfTheTables) {
  // Tables of the t distribution, 97.5 %, to the digits that they give.
  EXPECT_NEAR(student_t_975(1), 12.7062, 1e-4);
  EXPECT_NEAR(student_t_975(2), 4.30265, 1e-5);
  EXPECT_NEAR(student_t_975(3), 3.18245, 1e-3);
  EXPECT_NEAR(student_t_975(4), 2.77645, 1e-3);
  EXPECT_NEAR(student_t_975(9), 2.26216, 1e-4);
  EXPECT_NEAR(student_t_975(19), 2.09302, 1e-5);
  EXPECT_NEAR(student_t_975(99), 1.98422, 1e-5);
  EXPECT_NEAR(student_t_975(1000000), 1.95997, 1e-5);
}

TEST(Interval, OfAMeanIsTSpreadsOverTheRootOfTheCountWide) {
  const Interval interval = mean_interval_95(10, 2, 100);
  EXPECT_NEAR(interval.low, 10 - 1.98422 * 0.2, 1e-5);
  EXPECT_NEAR(interval.high, 10 + 1.98422 * 0.2, 1e-5);
}

TEST(Interval, OfAShareStaysWithinItsBoundsAndIsNoPoint) {
  // Wilson, 0 of n: from 0 to z^2 / (n + z^2).
  const double z2 = 1.959964 * 1.959964;
  EXPECT_NEAR(share_interval_95(0, 100).low, 0, 1e-12);
  EXPECT_NEAR(share_interval_95(0, 100).high, z2 / (100 + z2), 1e-6);
  EXPECT_NEAR(share_interval_95(100, 100).low, 100 / (100 + z2), 1e-6);
  EXPECT_NEAR(share_interval_95(100, 100).high, 1, 1e-12);
  // One half is the middle of its interval, which is z / (2 sqrt(n + z^2)) wide to each side.
  EXPECT_NEAR(share_interval_95(50, 100).high, 0.5 + 1.959964 / (2 * std::sqrt(100 + z2)), 1e-6);
}

}  // namespace
