// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/score/scoring.hpp"
#include "experiment/score/support.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/score/support_fixture.hpp"

namespace {

using namespace support_fixture;

TEST(StabilityMetric, HasTheMarginsOfATable) {
  test::TestWorld test(table_world(0.15) + "metrics: [{name: s, type: stability, vehicle: t, from_s: 1}]\n");
  experiment::Scoring scoring(test.world);
  for (int i = 0; i < 2000; ++i) {
    test.world.step();
    scoring.after_step();
  }
  const auto figures = scoring.figures();
  EXPECT_NEAR(figures.at("s.static_min_m"), 0.15, 1e-4);
  EXPECT_NEAR(figures.at("s.static_mean_m"), 0.15, 1e-4);
  EXPECT_NEAR(figures.at("s.zmp_min_m"), 0.15, 1e-3);
  EXPECT_NEAR(figures.at("s.nesm_min_m"), std::hypot(0.15, 0.5) - 0.5, 1e-4);
  EXPECT_EQ(figures.at("s.carried_share"), 1);
  EXPECT_NEAR(figures.at("s.static_m"), 0.15, 1e-4);
  EXPECT_NEAR(figures.at("s.zmp_m"), 0.15, 1e-3);
  EXPECT_NEAR(figures.at("s.capture_m"), 0.15, 1e-3);
}

}  // namespace
