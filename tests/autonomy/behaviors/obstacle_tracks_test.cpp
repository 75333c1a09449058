// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/obstacle_tracks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/autonomy/second.hpp"

namespace {

using autonomy::Motion;
using autonomy::Obstacle;
using autonomy::ObstacleTracks;
using autonomy::Scan;
using autonomy::Vector2d;
using std::numbers::pi;
using test::second;

constexpr double degree = pi / 180;

/// Scan of 360 beams, counter-clockwise from astern, of discs as seen from `own`.
Scan scan_of(const std::vector<Obstacle>& discs, const Motion& own) {
  Scan scan{std::vector<float>(360, 100.0f), -pi, degree};
  for (std::size_t i = 0; i < 360; ++i) {
    const Vector2d direction_W = autonomy::turned({1, 0}, own.yaw_rad - pi + static_cast<double>(i) * degree);
    for (const Obstacle& disc : discs) {
      const Vector2d d_W = disc.p_W - own.p_W;
      const double along_m = d_W.dot(direction_W);
      const double across2_m2 = d_W.squaredNorm() - along_m * along_m;
      if (along_m <= 0 || across2_m2 > disc.radius_m * disc.radius_m) continue;
      const double range_m = along_m - std::sqrt(disc.radius_m * disc.radius_m - across2_m2);
      scan.ranges_m[i] = std::min(scan.ranges_m[i], static_cast<float>(range_m));
    }
  }
  return scan;
}

Motion at(std::int64_t utime, const Vector2d& p_W, double yaw_rad) {
  return {utime, p_W, Vector2d::Zero(), yaw_rad};
}

TEST(ObstacleTracks, PutEchoesIntoTheWorldByTheOwnPose) {
  // A pile of 1 m at (10, 20); from (10, 5), heading north, its front is 14 m ahead.
  ObstacleTracks tracks({});
  const Motion own = at(second, {10, 5}, pi / 2);
  tracks.receive(scan_of({{{10, 20}, {0, 0}, 1}}, own), own);
  const auto obstacles = tracks.at(second);
  ASSERT_EQ(obstacles.size(), 1u);
  // Its visible ends are at most its radius from its middle, and the nearest point at the distance less the radius.
  EXPECT_NEAR(obstacles[0].p_W.x(), 10, 0.1);
  EXPECT_GT(obstacles[0].p_W.y(), 19);
  EXPECT_LT(obstacles[0].p_W.y(), 20);
  EXPECT_LE(obstacles[0].radius_m, 1.1);
  EXPECT_EQ(obstacles[0].v_W.norm(), 0);
}

TEST(ObstacleTracks, KnowTheVelocityOfWhatMovesAlone) {
  ObstacleTracks tracks({});
  const Motion still = at(0, {0, 0}, 0);
  const Vector2d v_W(-1, 0.5);
  for (int i = 0; i <= 60; ++i) {
    Motion own = still;
    own.utime = i * second / 5;
    tracks.receive(scan_of({{Vector2d(20, 0) + v_W * (0.2 * i), v_W, 0.4}}, own), own);
  }
  const auto obstacles = tracks.at(60 * second / 5 + second);
  ASSERT_EQ(obstacles.size(), 1u);
  // The beams are up to 0.35 m apart, so that the middle of the echoes jumps by some 0.1 m.
  EXPECT_NEAR(obstacles[0].v_W.x(), -1, 0.15);
  EXPECT_NEAR(obstacles[0].v_W.y(), 0.5, 0.15);
  // A second later than the last scan, it is a second further.
  EXPECT_NEAR(obstacles[0].p_W.x(), 20 - 12 - 1, 0.6);
}

TEST(ObstacleTracks, DivideAWallIntoStillPieces) {
  ObstacleTracks::Params params;
  params.extent_m = 3;
  ObstacleTracks tracks(params);
  for (int i = 0; i < 20; ++i) {
    // Alongside a wall at y = 5 from x = -10 to 10, at 1 m/s.
    const Motion own = at(i * second / 5, {0.2 * i, 0}, 0);
    Scan scan{std::vector<float>(360, 100.0f), -pi, degree};
    for (std::size_t k = 181; k < 360; ++k) {
      const double angle_rad = -pi + static_cast<double>(k) * degree;
      const double range_m = 5 / std::sin(angle_rad);
      if (std::abs(own.p_W.x() + range_m * std::cos(angle_rad)) <= 10) scan.ranges_m[k] = static_cast<float>(range_m);
    }
    tracks.receive(scan, own);
  }
  const auto obstacles = tracks.at(19 * second / 5);
  EXPECT_GE(obstacles.size(), 20u / 4);  // pieces of 3 m and the step between two beams
  for (const Obstacle& piece : obstacles) {
    EXPECT_EQ(piece.v_W.norm(), 0);
    EXPECT_LT(piece.radius_m, 1.6);
    EXPECT_NEAR(piece.p_W.y(), 5, 1e-3);
  }
}

TEST(ObstacleTracks, ForgetWhatWasNotSeenForSomeTimeAndIgnoreAScanWithoutHeading) {
  ObstacleTracks::Params params;
  params.memory_s = 3;
  ObstacleTracks tracks(params);
  const Motion own = at(second, {0, 0}, 0);
  const Scan scan = scan_of({{{10, 0}, {0, 0}, 1}}, own);
  tracks.receive(scan, at(second, {0, 0}, autonomy::unknown));
  EXPECT_TRUE(tracks.at(second).empty());
  tracks.receive(scan, own);
  EXPECT_EQ(tracks.at(4 * second).size(), 1u);
  EXPECT_TRUE(tracks.at(4 * second + 1).empty());
}

TEST(ObstacleTracks, IgnoreBeamsWithoutAnEcho) {
  ObstacleTracks tracks({});
  Scan scan{std::vector<float>(360, std::numeric_limits<float>::infinity()), -pi, degree};
  scan.ranges_m[10] = std::numeric_limits<float>::quiet_NaN();
  scan.ranges_m[20] = 0;
  const Motion own = at(second, {0, 0}, 0);
  tracks.receive(scan, own);
  EXPECT_TRUE(tracks.at(second).empty());
}

}  // namespace
