// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/allan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

TEST(Allan, OfSixSamplesIsWhatOneWorksOutByHand) {
  const std::vector<double> samples = {1, 3, 2, 6, 4, 5};
  // tau = dt: differences 2, -1, 4, -2, 1; squares 4 + 1 + 16 + 4 + 1 = 26; 26 / 5 / 2.
  EXPECT_NEAR(sim::allan_deviation_at(samples, 0.1, 0.1).deviation, std::sqrt(2.6), 1e-12);
  // tau = 2 dt: means of two 2, 2.5, 4, 5, 4.5; two apart they differ by 2, 2.5, 0.5; 10.5 / 3 / 2.
  EXPECT_NEAR(sim::allan_deviation_at(samples, 0.1, 0.2).deviation, std::sqrt(1.75), 1e-12);
}

TEST(Allan, DoesNotSeeAConstant) {
  const std::vector<double> samples(100, 9.80665);
  for (const sim::AllanPoint& point : sim::allan_deviation(samples, 0.01)) EXPECT_NEAR(point.deviation, 0, 1e-12);
}

TEST(Allan, OfARampIsTheSlopeTimesTauByRootTwo) {
  std::vector<double> samples;
  for (int i = 0; i < 1000; ++i) samples.push_back(0.3 * i * 0.01);  // 0.3 per second
  const auto points = sim::allan_deviation(samples, 0.01);
  for (const sim::AllanPoint& point : points)  // IEEE Std 952-1997
    EXPECT_NEAR(point.deviation, 0.3 * point.tau_s / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(points.front().tau_s, 0.01);
  EXPECT_NEAR(points.back().tau_s, 2.5, 0.6);  // a quarter of the record, less up to a step of the ladder
  EXPECT_LE(points.back().tau_s, 2.5);
}

TEST(Allan, OfNothingIsNothing) {
  EXPECT_TRUE(sim::allan_deviation({}, 0.01).empty());
}

}  // namespace
