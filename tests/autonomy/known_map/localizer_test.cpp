// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/localizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "shoal/message_codec.hpp"
#include "sim/base/math.hpp"
#include "tests/autonomy/known_map/flat_map.hpp"
#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::LikelihoodField;
using autonomy::Localizer;
using autonomy::Pose2;
using autonomy::Vector2d;

constexpr std::int64_t localizer_second = 1'000'000;

/// The map of the hall of drawn_room.hpp, without errors.
std::shared_ptr<const LikelihoodField> hall_field() {
  shoal::occupancy_grid_t map = test::flat_map({-9, -6}, {9, 6}, 0.05);
  test::set_box(map, {-9, -6}, {9, 6}, -1);
  test::set_box(map, {-8, -5}, {8.05, 5.05});
  test::set_box(map, {-7.95, -4.95}, {8, 5}, 0);
  test::set_box(map, {-5, 2}, {-2.95, 4.05});
  test::set_box(map, {2, -4}, {5.05, -2.95});
  test::set_box(map, {5.5, 1}, {6.05, 1.55});
  return std::make_shared<LikelihoodField>(map);
}

/// A vehicle in the hall whose odometry turns 2 % and drives 1 % too far.
struct LocalizerRun {
  explicit LocalizerRun(const Localizer::Params& params, const Pose2& start) : localizer(field, params), truth(start) {}

  void look() {
    utime += localizer_second;
    localizer.receive(test::odometry_at(odometry, utime));
    localizer.receive(room.scan(truth, utime));
    estimate = localizer.step();
    ASSERT_TRUE(estimate);
  }
  void drive(double forward_m, double turn_rad) {
    truth.yaw_rad += turn_rad;
    truth.p_W += forward_m * Vector2d(std::cos(truth.yaw_rad), std::sin(truth.yaw_rad));
    odometry.yaw_rad += 1.02 * turn_rad;
    odometry.p_W += 1.01 * forward_m * Vector2d(std::cos(odometry.yaw_rad), std::sin(odometry.yaw_rad));
    look();
  }
  /// Round the middle of the hall.
  void drive_round() {
    for (int side = 0; side < 4; ++side) {
      const int steps = side % 2 == 0 ? 10 : 4;
      for (int i = 0; i < steps; ++i) drive(0.6, 0);
      for (int i = 0; i < 4; ++i) drive(0, std::numbers::pi / 8);
    }
  }
  double error_m() const { return (localizer.pose().p_W - truth.p_W).norm(); }
  double std_m() const { return std::sqrt(estimate->covariance_m2[0] + estimate->covariance_m2[4]); }

  static inline const std::shared_ptr<const LikelihoodField> field = hall_field();
  test::DrawnRoom room = test::hall();
  Localizer localizer;
  Pose2 truth, odometry;
  std::int64_t utime = 0;
  std::optional<shoal::estimate_t> estimate;
};

const Pose2 hall_start{{-3, -1}, 0};

Localizer::Params known_start() {
  Localizer::Params params;
  params.start = hall_start;
  return params;
}

TEST(Localizer, KeepsThePoseThatOdometryLoses) {
  LocalizerRun run(known_start(), hall_start);
  run.look();
  for (int round = 0; round < 3; ++round) {
    run.drive_round();
    EXPECT_LT(run.error_m(), 0.1);  // the width of the likelihood field
    EXPECT_LT(std::abs(sim::wrap_angle(run.localizer.pose().yaw_rad - run.truth.yaw_rad)), 0.05);
  }
  EXPECT_GT(std::abs(run.odometry.yaw_rad - run.truth.yaw_rad), 0.3);
  EXPECT_FALSE(run.localizer.is_lost());
  // Few particles suffice for what is known.
  EXPECT_LT(run.localizer.particles(), 1000U);
}

TEST(Localizer, FindsAVehicleAnywhereInTheHall) {
  for (const Pose2& start : {Pose2{{-6.5, -3}, 0.4}, Pose2{{6.5, 3.5}, -2.2}, Pose2{{1, 1}, 3.0}}) {
    LocalizerRun run({}, start);
    run.look();
    for (int i = 0; i < 16; ++i) run.drive(0, 0.4);
    EXPECT_LT(run.error_m(), 0.1);
    EXPECT_LT(run.std_m(), 0.3);
  }
}

TEST(Localizer, FindsACarriedVehicleAgain) {
  LocalizerRun run(known_start(), hall_start);
  run.look();
  run.drive_round();
  EXPECT_LT(run.error_m(), 0.1);
  run.truth = {{6.5, -1}, 2.2};
  for (int i = 0; i < 30; ++i) run.drive(0, 0.4);
  EXPECT_LT(run.error_m(), 0.1);
  EXPECT_LT(run.std_m(), 0.3);
}

TEST(Localizer, NoticesAtRestThatItWasCarried) {
  LocalizerRun run(known_start(), hall_start);
  run.look();
  run.drive_round();
  run.truth = {{6.5, -1}, 2.2};
  for (int i = 0; i < 10; ++i) run.look();
  // It is uncertain, or has found the place by these scans alone.
  EXPECT_TRUE(run.std_m() > 0.5 || run.error_m() < 0.3) << run.std_m() << ' ' << run.error_m();
}

TEST(Localizer, NoticesThatItWasCarriedBeforeItHasMoved) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Localizer::Params params = known_start();
    params.seed = seed;
    LocalizerRun run(params, hall_start);
    for (int i = 0; i < 20; ++i) run.look();
    run.truth = {{6.5, -1}, 2.2};
    for (int i = 0; i < 60; ++i) run.look();
    EXPECT_TRUE(run.std_m() > 0.5 || run.error_m() < 0.3) << seed << ": " << run.std_m() << ' ' << run.error_m();
  }
}

TEST(Localizer, FollowsAMotionThatIsTooSlowToDifferFromNoise) {
  LocalizerRun run(known_start(), hall_start);
  run.look();
  for (int i = 0; i < 400; ++i) run.drive(0.002, 0.008);
  EXPECT_LT(run.error_m(), 0.1);
}

TEST(Localizer, DoesNotGetSurerByLookingAtOnePlace) {
  LocalizerRun run(known_start(), hall_start);
  run.look();
  run.drive_round();
  const double std_m = run.std_m();
  for (int i = 0; i < 100; ++i) run.look();
  EXPECT_EQ(run.std_m(), std_m);
}

TEST(Localizer, IsAFunctionOfItsMessagesAndItsSeed) {
  const auto poses = [](std::uint64_t seed) {
    Localizer::Params params = known_start();
    params.seed = seed;
    LocalizerRun run(params, hall_start);
    run.look();
    run.drive_round();
    // A copy continues as the original.
    LocalizerRun copy = run;
    run.drive(0.6, 0.1);
    copy.drive(0.6, 0.1);
    EXPECT_EQ(copy.localizer.pose().p_W, run.localizer.pose().p_W);
    return run.localizer.pose().p_W;
  };
  EXPECT_EQ(poses(1), poses(1));
  EXPECT_NE(poses(1), poses(2));
}

TEST(Localizer, NeedsAMapWithAFreePlaceAndPossibleOdometry) {
  EXPECT_THROW(LikelihoodField(test::flat_map({0, 0}, {0, 0}, 0.05)), shoal::MessageError);
  shoal::occupancy_grid_t map = test::flat_map({0, 0}, {1, 1}, 0.05);
  test::set_box(map, {0, 0}, {1, 1}, -1);
  EXPECT_THROW(LikelihoodField{map}, std::invalid_argument);
  Localizer localizer(LocalizerRun::field, {});
  EXPECT_FALSE(localizer.step());
  shoal::odometry_t odometry{};
  odometry.x_m = 1e9;
  EXPECT_THROW(localizer.receive(odometry), shoal::MessageError);
}

}  // namespace
