// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/mapper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "sim/base/math.hpp"
#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::Mapper;
using autonomy::Pose2;
using autonomy::Vector2d;

constexpr std::int64_t second = 1'000'000;
/// A time by the clock of a vehicle, whose epoch is not the start of the run.
constexpr std::int64_t epoch = 1'767'225'600 * second;

Mapper::Params hall_params() {
  Mapper::Params params;
  params.map.low_W = {-9, -6};
  params.map.high_W = {9, 6};
  return params;
}

/// A vehicle in the hall whose odometry turns 2 % and drives 1 % too far.
struct HallRun {
  explicit HallRun(const Mapper::Params& params = hall_params()) : mapper(params), truth(params.start) {}

  void look() {
    utime += second;
    mapper.receive(test::odometry_at(odometry, utime));
    mapper.receive(room.scan(truth, utime));
    estimate = mapper.step();
  }
  void drive(double forward_m, double turn_rad) {
    truth.yaw_rad += turn_rad;
    truth.p_W += forward_m * Vector2d(std::cos(truth.yaw_rad), std::sin(truth.yaw_rad));
    odometry.yaw_rad += 1.02 * turn_rad;
    odometry.p_W += 1.01 * forward_m * Vector2d(std::cos(odometry.yaw_rad), std::sin(odometry.yaw_rad));
    look();
  }
  /// Round the middle of the hall, 20 m of it, with the corners.
  void drive_round() {
    for (int side = 0; side < 4; ++side) {
      const int steps = side % 2 == 0 ? 10 : 4;
      for (int i = 0; i < steps; ++i) drive(0.6, 0);
      for (int i = 0; i < 4; ++i) drive(0, std::numbers::pi / 8);
    }
  }
  double error_m() const { return (mapper.pose().p_W - truth.p_W).norm(); }

  test::DrawnRoom room = test::hall();
  Mapper mapper;
  Pose2 truth, odometry;
  std::int64_t utime = epoch;
  std::optional<shoal::estimate_t> estimate;
};

Mapper::Params from(const Vector2d& p_W) {
  Mapper::Params params = hall_params();
  params.start.p_W = p_W;
  return params;
}

TEST(Mapper, KeepsThePoseThatOdometryLoses) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 5; ++round) run.drive_round();
  // 100 m and five turns: odometry alone is off by 0.6 rad, and by meters.
  EXPECT_GT(std::abs(run.odometry.yaw_rad - run.truth.yaw_rad), 0.5);
  // Half a cell.
  EXPECT_LT(run.error_m(), 0.025);
  EXPECT_LT(std::abs(sim::wrap_angle(run.mapper.pose().yaw_rad - run.truth.yaw_rad)), 0.01);
  EXPECT_EQ(run.mapper.times_lost(), 0);
  EXPECT_EQ(run.estimate->utime, run.utime);
}

TEST(Mapper, MapsTheWallsOfTheHall) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  const shoal::occupancy_grid_t map = run.mapper.map_message();
  ASSERT_EQ(map.ncells, 360 * 240);
  ASSERT_EQ(map.cells.size(), static_cast<std::size_t>(map.ncells));
  const auto percent = [&](double x_m, double y_m) {
    const int column = static_cast<int>(std::floor((x_m - map.origin_m[0]) / map.cell_m));
    const int row = static_cast<int>(std::floor((y_m - map.origin_m[1]) / map.cell_m));
    return static_cast<int>(map.cells[static_cast<std::size_t>(row * map.width + column)]);
  };
  EXPECT_LT(percent(0, 0), 10);
  EXPECT_EQ(percent(0, 5.5), -1);  // behind the wall
  // Along the north wall: an occupied cell on either side of its line.
  int mapped = 0;
  for (double x_m = -2; x_m < 7; x_m += 0.05) mapped += percent(x_m, 4.99) > 65 || percent(x_m, 5.01) > 65 ? 1 : 0;
  EXPECT_GT(mapped, 0.95 * 180);
}

TEST(Mapper, TheErrorOfItsFirstScanIsNotThatOfTheMap) {
  // The first scan is as from 5 cm ahead; then it stands for 100 s.
  HallRun run(from({-3, -1}));
  run.truth.p_W.x() += 0.05;
  run.look();
  run.truth.p_W.x() -= 0.05;
  for (int i = 0; i < 100; ++i) run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  EXPECT_LT(run.error_m(), 0.025);
}

TEST(Mapper, OnlyScansOfThePlaceOfTheStartAreInTheMean) {
  // It moves by less than the distance for a new scan of the survey, and stands there for long.
  HallRun run(from({-3, -1}));
  for (int i = 0; i < 10; ++i) run.look();
  run.drive(0.08, 0);
  for (int i = 0; i < 100; ++i) run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  EXPECT_LT(run.error_m(), 0.025);
}

TEST(Mapper, AMoveWhileOdometryWasSilentCountsOnce) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  // 0.3 m without odometry, which the scans show; then it is back and has them, too.
  for (int i = 0; i < 8; ++i) {
    run.truth.p_W.x() += i >= 2 ? 0.05 : 0;
    run.utime += second;
    run.mapper.receive(run.room.scan(run.truth, run.utime));
    run.mapper.step();
  }
  EXPECT_LT(run.error_m(), 0.05);
  run.odometry.p_W += 0.3 * Vector2d(std::cos(run.odometry.yaw_rad), std::sin(run.odometry.yaw_rad));
  run.look();
  EXPECT_LT(run.error_m(), 0.05);
  EXPECT_EQ(run.mapper.times_lost(), 0);
}

TEST(Mapper, NoiseOfOdometryAtRestDoesNotMoveIt) {
  HallRun run(from({-3, -1}));
  run.look();
  run.drive_round();
  run.look();
  const Pose2 before = run.mapper.pose();
  for (const double noise_rad : {0.004, -0.003, 0.005}) {
    run.odometry.yaw_rad += noise_rad;
    run.odometry.p_W.x() += 0.001;
    run.look();
    EXPECT_EQ(run.mapper.pose().yaw_rad, before.yaw_rad);
    EXPECT_EQ(run.mapper.pose().p_W, before.p_W);
  }
}

TEST(Mapper, FindsItsPlaceAgainAfterItWasCarried) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  run.truth = {{6.5, -1.5}, 2.5};  // odometry does not notice
  int seconds = 0;
  for (; seconds < 60 && (seconds < 5 || run.mapper.is_lost()); ++seconds) {
    run.drive(0, 0.4);
    if (run.mapper.is_lost()) {
      EXPECT_GT(run.estimate->covariance_m2[0], 1);  // it says that it does not know
    }
  }
  EXPECT_EQ(run.mapper.times_lost(), 1);
  EXPECT_FALSE(run.mapper.is_lost()) << seconds;
  run.drive(0.1, 0);
  EXPECT_LT(run.error_m(), 0.1);
}

TEST(Mapper, IsNotFoundByAFewBeams) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  run.truth = {{6.5, -1.5}, 2.5};
  for (int i = 0; i < 5; ++i) run.look();
  ASSERT_TRUE(run.mapper.is_lost());
  // Three beams that fit where it was.
  run.utime += second;
  shoal::planar_lidar_t scan = run.room.scan(run.mapper.pose(), run.utime);
  for (int i = 0; i < scan.nranges; ++i)
    if (i % 60 != 30) scan.ranges[static_cast<std::size_t>(i)] = 20;
  run.mapper.receive(test::odometry_at(run.odometry, run.utime));
  run.mapper.receive(scan);
  EXPECT_TRUE(run.mapper.step());
  EXPECT_TRUE(run.mapper.is_lost());
}

TEST(Mapper, StaysWhereItIsWhenSomethingNewStandsInTheHall) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  run.room.add_box({0, 1.5}, {2, 3});
  for (int round = 0; round < 2; ++round) run.drive_round();
  EXPECT_EQ(run.mapper.times_lost(), 0);
  EXPECT_LT(run.error_m(), 0.025);
  EXPECT_GT(run.mapper.map().field({1, 1.5}), 0.5);
}

TEST(Mapper, StaysWhereItIsWhenWhatStoodBeforeItHasGone) {
  HallRun run(from({-3, -1}));
  run.look();
  for (int round = 0; round < 2; ++round) run.drive_round();
  // A truck arrives to the west, is mapped, and leaves when it covers 147 of 180 degrees: the beams pass through where
  // it was and end at the wall behind.
  run.room.add_box({-4.5, -3}, {-4, 0.5});
  for (int i = 0; i < 8; ++i) run.drive(0, std::numbers::pi / 8);
  for (int i = 0; i < 100; ++i) run.look();
  for (int i = 0; i < 5; ++i) run.drive(0.1, 0);
  EXPECT_GT(run.mapper.map().field({-4, -1}), 0.5);
  run.room.walls.resize(run.room.walls.size() - 4);
  for (int i = 0; i < 10; ++i) run.drive(0, 0.02);
  EXPECT_EQ(run.mapper.times_lost(), 0);
  EXPECT_LT(run.error_m(), 0.05);
}

TEST(Mapper, ItsCopyMakesTheSameDecisions) {
  HallRun run(from({-3, -1}));
  run.look();
  run.drive_round();
  HallRun copy = run;
  run.drive_round();
  copy.drive_round();
  EXPECT_EQ(run.mapper.pose().p_W, copy.mapper.pose().p_W);
  EXPECT_EQ(shoal::encode(run.mapper.map_message()), shoal::encode(copy.mapper.map_message()));
}

TEST(Mapper, DoesNothingWithoutAScanOrOdometry) {
  Mapper mapper(hall_params());
  EXPECT_FALSE(mapper.step());
  mapper.receive(test::hall().scan({}, epoch));
  EXPECT_FALSE(mapper.step());
  shoal::odometry_t far{};
  far.x_m = 1e7;
  EXPECT_THROW(mapper.receive(far), shoal::MessageError);
}

using autonomy::MeanScan;
using testing::ElementsAre;
using testing::FloatNear;

shoal::planar_lidar_t scan_of(const std::vector<float>& ranges_m) {
  shoal::planar_lidar_t scan{};
  scan.nranges = static_cast<std::int32_t>(ranges_m.size());
  scan.ranges = ranges_m;
  scan.radstep = 0.1F;
  return scan;
}

/// A float near 20 m is exact to 1e-6 m.
constexpr float rounding_m = 2e-6F;

TEST(MeanScan, HasTheMeanOfEachBeam) {
  MeanScan mean;
  mean.add(scan_of({2.00F, 20}));
  mean.add(scan_of({2.02F, 20}));
  mean.add(scan_of({1.98F, 20}));
  mean.add(scan_of({2.04F, 20}));
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(FloatNear(2.01F, rounding_m), 20));
}

TEST(MeanScan, LeavesOutABeamThatGrazesAnEdge) {
  MeanScan mean;
  mean.add(scan_of({2, 3}));
  mean.add(scan_of({5, 3}));
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(0, 3));
}

TEST(MeanScan, AnOutlierDoesNotCount) {
  MeanScan mean;
  for (int i = 0; i < 10; ++i) mean.add(scan_of({i == 5 ? 7.0F : 2.0F}));
  mean.add(scan_of({2.11F}));
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(FloatNear(2.011F, rounding_m)));
}

TEST(MeanScan, IgnoresAScanWithOtherBeams) {
  MeanScan mean;
  EXPECT_FALSE(mean.scan());
  mean.add(scan_of({2, 3}));
  mean.add(scan_of({2.01F}));
  shoal::planar_lidar_t turned = scan_of({2.01F, 3.01F});
  turned.rad0 = 1;
  mean.add(turned);
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(2, 3));
}

}  // namespace
