// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::far_m;
using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

// On straight lines of equal range, with a linear motion, least squares over the trajectory are the Kalman filter.
TEST(FixedLagSmoother, IsTheKalmanFilterOfALinearProblem) {
  navigation::Setup setup = nav_setup(2, 0, {0, 0}, 2);
  setup.team[0].errors.clock_s = 0.001;
  setup.team[0].errors.clock_drift = 1e-6;  // a state without noise
  const auto smoother = started("fls", setup), filter = started("naive", setup);
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 1; i <= 30; ++i) {  // 300 s: the oldest are marginalized
    const Time now = 10 * i * nav_second;
    for (const auto& own : {smoother.get(), filter.get()}) {
      own->predict(now, {0.1, 0}, 0.01 * Matrix2::Identity());
      own->on_range(received_from(1, sender->make_payload(0, 100), far_m + i + (i % 3), 1, now));
      if (i % 10 == 0) own->fix(now, {i + 0.5, -0.2}, 1);
    }
    const Estimate a = smoother->now(now), b = filter->now(now);
    EXPECT_NEAR((a.p_W - b.p_W).norm(), 0, 1e-3) << i;  // points of equal range bend by (2 m)^2 / far_m
    EXPECT_TRUE(a.P.isApprox(b.P, 1e-3)) << i;
    EXPECT_NEAR(a.clock_error_s, b.clock_error_s, 1e-6) << i;
  }
}

TEST(FixedLagSmoother, FindsAStartThatIsWrongByHundredsOfMeters) {
  navigation::Setup setup = nav_setup(3, 0, {0, 0}, 200);
  const auto smoother = started("fls", setup);
  const auto west = started("naive", nav_setup(3, 1, {-300, 0}, 0.1));
  const auto south = started("naive", nav_setup(3, 2, {0, -300}, 0.1));
  const Vector2 truth(150, 220);  // at rest
  for (int i = 1; i <= 6; ++i) {
    const Time now = 10 * i * nav_second;
    smoother->predict(now, {0, 0}, 1e-4 * Matrix2::Identity());
    const bool is_west = i % 2 == 0;
    const Vector2 sender = is_west ? Vector2(-300, 0) : Vector2(0, -300);
    const Bytes payload = (is_west ? west : south)->make_payload(0, 100);
    smoother->on_range(received_from(is_west ? 1 : 2, payload, (truth - sender).norm(), 1, now));
  }
  EXPECT_NEAR((smoother->now(60 * nav_second).p_W - truth).norm(), 0, 2);  // 4 sigma of 6 ranges of 1 m
}

}  // namespace
