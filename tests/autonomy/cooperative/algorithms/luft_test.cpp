// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "autonomy/filters/chi_square.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::nav_second;
using test::nav_setup;

TEST(PairwiseCommunication, KeepsACovarianceWhenFixesOpenThePosition) {
  const auto luft = algorithm_named("luft").make_team();
  for (const int vehicle : {0, 1}) {
    navigation::Setup setup = nav_setup(2, vehicle, {20.0 * vehicle, 0}, 1);
    setup.gate = autonomy::chi_square_999_1;
    luft->start(vehicle, setup);
  }
  Relative seen{.time = nav_second, .other = 1, .range_m = 20, .range_std_m = 0.1, .bearing_std_rad = 0.005};
  luft->on_bearing(0, seen);
  // Five fixes that are 100 m off, of which the last is used.
  for (int i = 2; i < 7; ++i) luft->fix(0, i * nav_second, {100, 0}, 3);
  EXPECT_NEAR(luft->now(0, 7 * nav_second).p_W.x(), 100, 1);
  // The vehicle is uncertain by 3 m, and correlated with the other one less than fully: both stay so after a relative
  // measurement that fits.
  seen.time = 7 * nav_second;
  seen.bearing_rad = std::numbers::pi;
  seen.range_m = 80;
  luft->on_bearing(0, seen);
  for (const int vehicle : {0, 1}) {
    const Matrix2 P = luft->now(vehicle, 7 * nav_second).P;
    EXPECT_GT(P(0, 0), 0) << vehicle;
    EXPECT_GT(P.determinant(), 0) << vehicle;
    EXPECT_LT(P.trace(), 18) << vehicle;
  }
}

TEST(PairwiseCommunication, IsTheCentralizedFilterForTwo) {
  // The approximations concern third vehicles, and own measurements after a meeting.
  const auto luft = algorithm_named("luft").make_team(), team = algorithm_named("cekf").make_team();
  for (TeamEstimator* each : {luft.get(), team.get()}) {
    each->start(0, nav_setup(2, 0, {0, 0}, 1));
    each->start(1, nav_setup(2, 1, {20, 0}, 2));
    for (int i = 1; i <= 10; ++i) {
      const Time now = i * nav_second;
      each->predict(0, now, {1, 0}, 0.1 * Matrix2::Identity());
      each->predict(1, now, {0, 1}, 0.2 * Matrix2::Identity());
      if (i == 1) each->fix(0, now, {1.5, 0.2}, 0.5);
      if (i % 2 != 0) continue;
      each->on_bearing(
          0,
          {.time = now, .other = 1, .range_m = 21, .bearing_rad = 0.2, .range_std_m = 0.15, .bearing_std_rad = 0.05});
    }
  }
  for (const int vehicle : {0, 1}) {
    const Estimate a = luft->now(vehicle, 10 * nav_second), b = team->now(vehicle, 10 * nav_second);
    EXPECT_LT((a.p_W - b.p_W).norm(), 1e-9);
    EXPECT_LT((a.P - b.P).norm(), 1e-9);
  }
}

}  // namespace
