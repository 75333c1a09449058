// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/set_points.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using motion::SetPoints;

/// A neck and a nod, both with 200 deg/s, 2 deg in a frame.  The nod is at least -5 deg, and 5 deg while the neck is
/// below -40 deg.
struct NoddingHead {
  static constexpr double deg = std::numbers::pi / 180, step_s = 0.01;
  static constexpr std::size_t neck = 0, nod = 1;

  NoddingHead() : points({limits, limits}, table(), step_s) {}
  static devices::JointLimitTable table() {
    std::vector<devices::JointLimitRow> rows(2);
    for (devices::JointLimitRow& row : rows) {
      row.joint = "nod";
      row.by = "neck";
    }
    rows[0].from_rad = -75 * deg;
    rows[0].low_rad = 5 * deg;
    rows[1].from_rad = -40 * deg;
    rows[1].low_rad = -5 * deg;
    return devices::JointLimitTable(
        rows, [](const std::string& name) -> std::optional<std::size_t> { return name == "neck" ? neck : nod; });
  }
  void move(double neck_velocity, double nod_velocity) {
    points.move(neck, neck_velocity, {});
    points.move(nod, nod_velocity, {});
    points.limit(both);
  }
  double neck_deg() const { return points.values()[neck] / deg; }
  double nod_deg() const { return points.values()[nod] / deg; }

  static constexpr SetPoints::Limits limits{-75 * deg, 45 * deg, 200 * deg};
  const std::vector<std::size_t> both{neck, nod};
  SetPoints points;
};

TEST(SetPoints, AJointWaitsUntilTheOtherIsWithinItsNewRange) {
  NoddingHead head;
  head.points.set(NoddingHead::neck, -39 * NoddingHead::deg);
  // From 0 to 5 deg are three frames: 2, 2 and 1 deg.
  const double neck_deg[] = {-39, -39, -41, -43}, nod_deg[] = {2, 4, 5, 5};
  for (int i = 0; i < 4; ++i) {
    head.move(-200 * NoddingHead::deg, 0);
    EXPECT_NEAR(head.neck_deg(), neck_deg[i], 1e-9) << i;
    EXPECT_NEAR(head.nod_deg(), nod_deg[i], 1e-9) << i;
    EXPECT_EQ(head.points.is_at_limit(NoddingHead::neck), i < 2) << i;
    EXPECT_EQ(head.points.is_at_limit(NoddingHead::nod), i < 3) << i;
  }
}

TEST(SetPoints, AJointThatMovesAwayFromTheLimitDoesNotWait) {
  NoddingHead head;
  head.points.set(NoddingHead::neck, -39 * NoddingHead::deg);
  head.move(-200 * NoddingHead::deg, 0);
  head.move(100 * NoddingHead::deg, -200 * NoddingHead::deg);
  EXPECT_NEAR(head.neck_deg(), -38, 1e-9);
  EXPECT_NEAR(head.nod_deg(), 0, 1e-9);
}

TEST(SetPoints, LimitsOfTwoJointsHoldAlsoWhenTheOtherCannotWait) {
  NoddingHead head;
  head.points.set(NoddingHead::neck, -41 * NoddingHead::deg);  // by a motion that plays
  head.points.move(NoddingHead::nod, 0, {});
  head.points.limit(std::vector<std::size_t>{NoddingHead::nod});
  EXPECT_NEAR(head.nod_deg(), 5, 1e-9);
}

TEST(SetPoints, AJointThatHasToReachItsGoalDoesNotWait) {
  NoddingHead head;
  head.points.set(NoddingHead::neck, -39 * NoddingHead::deg);
  // At 2 deg in a frame it must go now.
  head.points.move(NoddingHead::neck, 0, SetPoints::Goal{-45 * NoddingHead::deg, 2 * NoddingHead::step_s});
  head.points.move(NoddingHead::nod, 0, {});
  head.points.limit(head.both);
  EXPECT_NEAR(head.neck_deg(), -41, 1e-9);
  EXPECT_NEAR(head.nod_deg(), 5, 1e-9);
}

}  // namespace
