// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/tilt_filter.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace {

using autonomy::TiltFilter;

constexpr double period_s = 0.01, time_constant_s = 3;

/// A filter that gets both reports every 10 ms.
struct Filtered {
  void run(double time_s, double rate_radps, double tilt_rad) {
    for (const std::int64_t end = utime + std::llround(time_s * 1e6); utime < end;) {
      utime += 10'000;
      filter.correct(utime, tilt_rad);
      filter.predict(utime, rate_radps);
    }
  }
  TiltFilter filter{time_constant_s};
  std::int64_t utime = 1'000'000;
};

TEST(TiltFilter, FindsTheBiasOfTheGyro) {
  Filtered test;
  EXPECT_FALSE(test.filter.known());
  test.run(period_s, 0, 0.1);
  EXPECT_TRUE(test.filter.known());
  // The error of a filter with two poles at -1 / T is b t exp(-t / T), largest at T.  Steps of T / 300.
  const double bias_radps = 0.02;
  test.run(time_constant_s, bias_radps, 0.1);
  EXPECT_NEAR(test.filter.tilt_rad() - 0.1, bias_radps * time_constant_s / std::numbers::e, 0.01 * 0.022);
  test.run(10 * time_constant_s, bias_radps, 0.1);
  EXPECT_NEAR(test.filter.tilt_rad(), 0.1, 1e-4);
  EXPECT_NEAR(test.filter.bias_radps(), bias_radps, 1e-4);
  EXPECT_NEAR(test.filter.rate_radps(), 0, 1e-4);
}

TEST(TiltFilter, FollowsTheGyroAtOnceAndAnAccelerationHardly) {
  Filtered test;
  test.run(1, 0, 0);
  // It turns by 0.2 rad in 0.2 s, while the inclinometer shows the opposite.
  test.run(0.2, 1, -0.2);
  // At most 2 / T of an error of up to 0.4 rad for 0.2 s.
  EXPECT_NEAR(test.filter.tilt_rad(), 0.2, 2 / time_constant_s * 0.4 * 0.2);
  EXPECT_GT(test.filter.tilt_rad(), 0.15);
}

TEST(TiltFilter, MessagesOfAnotherTimeDoNotMoveIt) {
  constexpr std::int64_t latest = std::numeric_limits<std::int64_t>::max(), first = -latest - 1;
  for (const std::int64_t strange : {latest, first, std::int64_t{1}}) {
    Filtered test;
    test.run(1, 0, 0.1);
    test.filter.predict(strange, 1000);
    test.filter.correct(strange, 1);
    EXPECT_NEAR(test.filter.tilt_rad(), 0.1, 1e-12) << strange;
    test.run(1, 0, 0.1);
    EXPECT_NEAR(test.filter.tilt_rad(), 0.1, 1e-12) << strange;
  }
  Filtered test;
  test.run(1, 0, 0.1);
  EXPECT_FALSE(test.filter.predict(test.utime, 1));  // twice the same
  EXPECT_NEAR(test.filter.tilt_rad(), 0.1, 1e-12);
}

}  // namespace
