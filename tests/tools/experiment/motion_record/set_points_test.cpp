// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/motion_record/set_points.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

namespace {

using tools::SetPoints;

constexpr double deg = std::numbers::pi / 180, frame_s = 0.01;
constexpr std::size_t neck = 0, nod = 1;

/// A neck and a nod, both with 200 deg/s, 2 deg in a frame.  The nod is at least -5 deg, and above 5 deg while the neck
/// is below -40 deg.
SetPoints head() {
  std::vector<devices::JointLimitRow> rows(2);
  for (devices::JointLimitRow& row : rows) {
    row.joint = "nod";
    row.by = "neck";
  }
  rows[0].from_rad = -75 * deg;
  rows[0].low_rad = 5 * deg;
  rows[1].from_rad = -40 * deg;
  rows[1].low_rad = -5 * deg;
  const SetPoints::Limits limits{-75 * deg, 45 * deg, 200 * deg};
  const auto number_of = [](const std::string& name) -> std::optional<std::size_t> {
    return name == "neck" ? neck : nod;
  };
  return SetPoints({limits, limits}, devices::JointLimitTable(rows, number_of), frame_s);
}

void frame(SetPoints& points, double neck_velocity, double nod_velocity) {
  points.move(neck, neck_velocity, {});
  points.move(nod, nod_velocity, {});
  points.limit(std::vector<std::size_t>{neck, nod});
}

TEST(SetPoints, AJointWaitsUntilTheOtherIsWithinItsNewRange) {
  SetPoints points = head();
  points.set(neck, -39 * deg);
  std::vector<double> necks, nods;
  for (int i = 0; i < 4; ++i) {
    frame(points, -200 * deg, 0);
    necks.push_back(points.values()[neck] / deg);
    nods.push_back(points.values()[nod] / deg);
    EXPECT_EQ(points.is_at_limit(neck), i < 2) << i;
    EXPECT_EQ(points.is_at_limit(nod), i < 3) << i;
  }
  // From 0 to 5 deg are three frames: 2, 2 and 1 deg.
  const double expected_neck[] = {-39, -39, -41, -43}, expected_nod[] = {2, 4, 5, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(necks[i], expected_neck[i], 1e-9) << i;
    EXPECT_NEAR(nods[i], expected_nod[i], 1e-9) << i;
  }
}

TEST(SetPoints, TheOtherGoesOnWhenItMovesAwayFromTheLimit) {
  SetPoints points = head();
  points.set(neck, -39 * deg);
  frame(points, -200 * deg, 0);
  frame(points, 100 * deg, -200 * deg);
  EXPECT_NEAR(points.values()[neck], -38 * deg, 1e-12);
  EXPECT_NEAR(points.values()[nod], 0, 1e-12);
}

TEST(SetPoints, LimitsOfTwoJointsHoldAlsoWhenTheOtherCannotWait) {
  SetPoints points = head();
  points.set(neck, -41 * deg);  // by a motion that plays
  points.move(nod, 0, {});
  points.limit(std::vector<std::size_t>{nod});
  EXPECT_NEAR(points.values()[nod], 5 * deg, 1e-12);
}

TEST(SetPoints, AJointThatHasToReachItsGoalDoesNotWait) {
  SetPoints points = head();
  points.set(neck, -39 * deg);
  points.move(neck, 0, SetPoints::Goal{-45 * deg, 2 * frame_s});  // at 2 deg in a frame it must go now
  points.move(nod, 0, {});
  points.limit(std::vector<std::size_t>{neck, nod});
  EXPECT_NEAR(points.values()[neck], -41 * deg, 1e-12);
  EXPECT_NEAR(points.values()[nod], 5 * deg, 1e-12);
}

}  // namespace
