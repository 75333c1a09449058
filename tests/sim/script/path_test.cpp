// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/path.hpp"

#include <gtest/gtest.h>

namespace {

using sim::Path;
using sim::PathKind;
using sim::Vector3d;

const std::vector<Vector3d> bends = {{0, 0, 0}, {4, 1, 0}, {5, 5, 1}, {-2, 6, 2}, {-3, -1, 0}};

double nearest_m(const Path& path, const Vector3d& point) {
  double nearest = 1e9;
  for (double u = 0; u <= path.length(); u += 1e-3)
    nearest = std::min(nearest, (path.pose_at(u).translation() - point).norm());
  return nearest;
}

TEST(Path, OfWaypointsIsStraightAndHeadsAlong) {
  const Path path = Path::through(PathKind::waypoints, {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}}, false, {});
  EXPECT_DOUBLE_EQ(path.length(), 7);
  EXPECT_TRUE(path.pose_at(5).translation().isApprox(Vector3d(3, 2, 0)));
  EXPECT_NEAR(sim::yaw_of(path.pose_at(1).linear()), 0, 1e-15);
  EXPECT_NEAR(sim::yaw_of(path.pose_at(5).linear()), sim::degrees_to_radians(90), 1e-15);
}

TEST(Path, ThatIsClosedComesBackToItsFirstPoint) {
  const Path path = Path::through(PathKind::waypoints, {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}}, true, {});
  EXPECT_DOUBLE_EQ(path.length(), 12);  // 3, 4, 5
  EXPECT_NEAR(path.pose_at(12).translation().norm(), 0, 1e-12);
}

TEST(Path, KeepsTheOrientationItIsGiven) {
  const sim::Matrix3d R_WO = sim::rotation_from_rpy({0, 0, 0.5});
  const Path path = Path::through(PathKind::waypoints, {{0, 0, 0}, {0, 3, 0}}, false, R_WO);
  EXPECT_TRUE(path.pose_at(2).linear().isApprox(R_WO));
}

TEST(Path, ASplinePassesItsPointsOpenAndClosed) {
  for (const bool closed : {false, true}) {
    const Path path = Path::through(PathKind::spline, bends, closed, {});
    // The search steps by 1 mm; the last point of an open path may be a whole step away.
    for (const Vector3d& point : bends) EXPECT_LT(nearest_m(path, point), 1e-3) << closed;
    EXPECT_LT((path.pose_at(0).translation() - bends.front()).norm(), 1e-12);
    EXPECT_LT((path.pose_at(path.length()).translation() - (closed ? bends.front() : bends.back())).norm(), 1e-9);
  }
}

TEST(Path, ASplineIsTraveledAtConstantSpeed) {
  const Path path = Path::through(PathKind::spline, bends, true, {});
  const double du = path.length() / 20000;
  for (int i = 0; i < 20000; ++i) {
    const double chord_m = (path.pose_at((i + 1) * du).translation() - path.pose_at(i * du).translation()).norm();
    // A chord is shorter than its arc by (curvature * du)^2 / 24; with radii above 0.1 m that is below 1e-5 here.
    ASSERT_NEAR(chord_m / du, 1.0, 1e-5) << i;
  }
}

TEST(Path, ASplineThroughPointsOfALineIsTheLine) {
  const Path path = Path::through(PathKind::spline, {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {6, 0, 0}}, false, {});
  EXPECT_NEAR(path.length(), 6, 1e-9);
  for (double u = 0; u <= 6; u += 0.25) EXPECT_NEAR(path.pose_at(u).translation().x(), u, 1e-9);
}

TEST(Path, OfTimedPosesIsExactAtThemAndEvenBetween) {
  const Path path = Path::timed({{2, {0, 0, 0}, {0, 0, 0}}, {4, {2, 0, 0}, {0, 0, 1.0}}, {10, {2, 6, 0}, {0, 0, 1.0}}});
  EXPECT_DOUBLE_EQ(path.length(), 8);
  EXPECT_EQ(path.pose_at(2).translation(), Vector3d(2, 0, 0));
  EXPECT_NEAR(path.pose_at(1).translation().x(), 1, 1e-15);
  EXPECT_NEAR(sim::yaw_of(path.pose_at(1).linear()), 0.5, 1e-12);
  EXPECT_NEAR(path.pose_at(5).translation().y(), 3, 1e-15);
  EXPECT_EQ(path.pose_at(99).translation(), Vector3d(2, 6, 0));
}

}  // namespace
