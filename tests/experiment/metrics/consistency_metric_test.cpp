// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "messages/yaml/message_writer.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

constexpr const char* consistency = "  - {name: c, type: consistency, vehicle: r1, channel: est}\n";

TEST(Consistency, OfOneErrorIsItsSquareByTheInverseOfTheCovariance) {
  MetricWorld world(consistency);
  world.run_for(0.1);
  // P = [4 1.5; 1.5 1], det 1.75, inverse [1 -1.5; -1.5 4] / 1.75: e = (2, 1) gives (4 - 6 + 4) / 1.75.
  world.estimate({2, 1, 50}, some_covariance());
  world.run_for(0.01);
  EXPECT_NEAR(world.figure("c.nees_mean"), 2 / 1.75, 1e-3);
  EXPECT_EQ(world.figure("c.inside_95_share"), 1);
  EXPECT_EQ(world.figure("c.samples"), 1);
}

TEST(Consistency, OfAConsistentEstimateIsTheNumberOfItsDimensions) {
  for (const int dimensions : {2, 3}) {
    MetricWorld world("  - {name: c, type: consistency, vehicle: r1, channel: est, dimensions: " +
                      std::to_string(dimensions) + "}\n");
    const Eigen::Matrix3d P = some_covariance();
    const Eigen::Matrix3d L = P.llt().matrixL();
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    constexpr int count = 2000;
    for (int i = 0; i < count; ++i) {
      world.estimate(L * sim::Vector3d(normal(random), normal(random), normal(random)), P);
      if (i % 100 == 0) world.run_for(0.001);
    }
    world.run_for(0.001);
    ASSERT_EQ(world.figure("c.samples"), count);
    // A chi-square value of n dimensions has the mean n and the variance 2 n; four standard errors.
    EXPECT_NEAR(world.figure("c.nees_mean"), dimensions, 4 * std::sqrt(2.0 * dimensions / count));
    EXPECT_NEAR(world.figure("c.inside_95_share"), 0.95, 4 * std::sqrt(0.95 * 0.05 / count));
  }
}

TEST(Consistency, ShowsAnEstimateThatIsTooSure) {
  MetricWorld world(consistency);
  world.run_for(0.1);
  for (int i = 0; i < 10; ++i) world.estimate({2, 1, 0}, some_covariance() / 100);  // sigma a tenth of what it is
  world.run_for(0.01);
  EXPECT_NEAR(world.figure("c.nees_mean"), 100 * 2 / 1.75, 0.1);
  EXPECT_EQ(world.figure("c.inside_95_share"), 0);
}

TEST(Consistency, CountsAndIgnoresWhatIsNoCovariance) {
  MetricWorld world(consistency);
  world.run_for(0.1);
  Eigen::Matrix3d askew = some_covariance();
  askew(0, 1) = -1.5;
  world.estimate({1, 0, 0}, askew);
  world.estimate({1, 0, 0}, Eigen::Matrix3d::Zero());
  world.estimate({1, 0, 0}, -some_covariance());
  world.estimate({1, 0, 0}, Eigen::Matrix3d::Constant(std::nan("")));
  world.estimate({std::nan(""), 0, 0}, some_covariance());
  world.test.send("est", shoal::pose_t{});
  world.test.send("est", shoal::twist_command_t{});
  world.run_for(0.01);
  EXPECT_EQ(world.scoring.bad_messages(), 7);
  EXPECT_TRUE(std::isnan(world.figure("c.nees_mean")));
  EXPECT_TRUE(std::isnan(world.figure("c.inside_95_share")));
}

}  // namespace
