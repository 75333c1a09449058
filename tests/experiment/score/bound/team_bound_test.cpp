// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/team_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "sim/bus/bus.hpp"

namespace {

using experiment::TeamBound;
using experiment::VehicleErrors;
using Motion = experiment::VehicleErrors::Motion;

sim::Time seconds(double time_s) {
  return sim::from_seconds(time_s);
}

/// A vehicle with a DVL and a compass, without errors.
VehicleErrors submarine() {
  VehicleErrors errors;
  errors.motion = Motion::measured_velocity;
  errors.modems = {{"modem", sim::Vector3d::Zero()}};
  return errors;
}

/// A vehicle that knows its fixes only.
VehicleErrors beacon(double fix_std_m) {
  VehicleErrors errors;
  errors.gps = VehicleErrors::Gps{};
  errors.gps->position.white_std = fix_std_m;
  errors.modems = {{"modem", sim::Vector3d::Zero()}};
  return errors;
}

TeamBound::Options start_of(double std_m) {
  TeamBound::Options options;
  options.start_std_m = std_m;
  return options;
}

/// Moves vehicles with constant velocities from their places until `end_s`.
void travel(TeamBound& bound, const std::vector<sim::Vector3d>& from_W, const std::vector<sim::Vector3d>& v_W,
            double start_s, double end_s) {
  constexpr double interval_s = 0.2;
  const int steps = static_cast<int>(std::lround((end_s - start_s) / interval_s));
  for (int step = 0; step <= steps; ++step) {
    const double time_s = start_s + step * interval_s;
    std::vector<TeamBound::Pose> poses;
    for (std::size_t i = 0; i < from_W.size(); ++i) poses.push_back({from_W[i] + time_s * v_W[i], 0});
    bound.move(seconds(time_s), std::move(poses), true);
  }
}

/// Variances of east and north of the first vehicle at the end.
Eigen::Vector2d variances_of(const TeamBound& bound, double end_s) {
  TeamBound copy = bound;
  copy.advance(seconds(end_s));
  const Eigen::Index p = copy.position_index(0);
  return copy.covariance().diagonal().segment<2>(p);
}

TEST(TeamBound, OfDeadReckoningGrowsWithTheDistance) {
  VehicleErrors errors = submarine();
  errors.heading.slow = {{0.05, 0, 0}};
  errors.speed_scale_std = 0.03;
  TeamBound bound({errors}, 0, start_of(0.5));
  travel(bound, {{0, 0, -15}}, {{1.5, 0, 0}}, 0, 600);
  const Eigen::Vector2d variances = variances_of(bound, 600);
  EXPECT_NEAR(variances.x(), 0.25 + std::pow(0.03 * 900, 2), 1e-6);
  EXPECT_NEAR(variances.y(), 0.25 + std::pow(0.05 * 900, 2), 1e-6);
}

TEST(TeamBound, OfAClosedCourseForgetsAConstantHeadingError) {
  VehicleErrors errors = submarine();
  errors.heading.slow = {{0.05, 0, 0}};
  TeamBound bound({errors}, 0, start_of(0.5));
  travel(bound, {{0, 0, 0}}, {{1, 0, 0}}, 0, 100);
  travel(bound, {{200, 0, 0}}, {{-1, 0, 0}}, 100.2, 200);
  EXPECT_NEAR(variances_of(bound, 200).y(), 0.25, 1e-3);
}

TEST(TeamBound, OfWhiteVelocityErrorsIsARandomWalk) {
  VehicleErrors errors = submarine();
  errors.beam_std_mps = 0.02;
  errors.velocity_period_s = 0.2;
  TeamBound bound({errors}, 0, start_of(0));
  travel(bound, {{0, 0, 0}}, {{1, 0, 0}}, 0, 100);
  // 500 samples, each with an error of 0.02 m/s for 0.2 s.
  EXPECT_NEAR(variances_of(bound, 100).x(), 500 * std::pow(0.02 * 0.2, 2), 1e-9);
}

TEST(TeamBound, OfWheelsGrowsWithTheErrorOfTheHeading) {
  VehicleErrors errors;
  errors.motion = Motion::wheels;
  TeamBound::Options options = start_of(0);
  options.start_heading_std_rad = 0.03;
  TeamBound bound({errors}, 0, options);
  travel(bound, {{0, 0, 0}}, {{1, 0, 0}}, 0, 100);
  EXPECT_NEAR(variances_of(bound, 100).y(), std::pow(0.03 * 100, 2), 1e-6);
}

TEST(TeamBound, OfABeaconIsItsNewestFix) {
  VehicleErrors errors = beacon(0.3);
  errors.gps->position.slow = {{0.4, 0, 60}};
  TeamBound bound({errors}, 0, start_of(1000));
  travel(bound, {{0, 0, 0}}, {{1, 0, 0}}, 0, 100);
  for (int i = 1; i < 100; ++i) bound.add_fix(seconds(i), 0);
  // Slow errors do not average out, and white ones of earlier fixes are of an unknown motion ago.
  const Eigen::Vector2d variances = variances_of(bound, 100);
  EXPECT_NEAR(variances.x(), 0.09 + 0.16, 1e-9);
  EXPECT_NEAR(variances.y(), 0.09 + 0.16, 1e-9);
  EXPECT_EQ(bound.result().fixes, 99);
}

TEST(TeamBound, OfFixesAlongAMeasuredMotionIsTheirMean) {
  VehicleErrors errors = submarine();
  errors.gps = beacon(1).gps;
  TeamBound bound({errors}, 0, start_of(1000));
  travel(bound, {{0, 0, 0}}, {{1, 0, 0}}, 0, 100);
  for (int i = 1; i <= 64; ++i) bound.add_fix(seconds(i), 0);
  EXPECT_NEAR(variances_of(bound, 100).x(), 1 / (1e-6 + 64.0), 1e-6);
}

/// A submerged vehicle at rest with a start of 10 m, and a beacon 100 m east of it whose fixes have 2 m.
struct RangePair {
  explicit RangePair(VehicleErrors own = submarine()) : bound({own, beacon(2)}, 0, start_of(10)) {
    travel(bound, {{0, 0, 0}, {100, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}, 0, 100);
  }
  void range(double sent_s, double known_after_s = 0) {
    bound.add_fix(seconds(sent_s) - sim::Time{1}, 1);
    const sim::Time arrived = seconds(sent_s + 100 / 1500.0);
    bound.add_range(seconds(sent_s), {1, {}}, arrived, {0, {}}, arrived + seconds(known_after_s), 0.01);
  }
  TeamBound bound;
};

TEST(TeamBound, OfRangesToABeaconIsThatOfTheirNumber) {
  RangePair pair;
  for (int i = 1; i <= 8; ++i) pair.range(10 * i);
  const Eigen::Vector2d variances = variances_of(pair.bound, 100);
  // Each has an error of fix and range of its own; stamps of 1 us are below 1 mm.
  EXPECT_NEAR(variances.x(), 1 / (1 / 100.0 + 8 / (4 + 0.01)), 1e-5);
  EXPECT_NEAR(variances.y(), 100, 1e-6);
  EXPECT_EQ(pair.bound.result().ranges, 8);
}

TEST(TeamBound, CountsARangeFromTheTimeOnAtWhichItIsKnown) {
  RangePair early, late;
  early.range(10);
  late.range(10, 3.5);
  EXPECT_NEAR(variances_of(early.bound, 12).x(), variances_of(late.bound, 20).x(), 1e-9);
  EXPECT_NEAR(variances_of(late.bound, 12).x(), 100, 1e-9);
}

TEST(TeamBound, SharesARangeWithTheErrorOfTheClock) {
  VehicleErrors own = submarine();
  own.clock_offset_std_s = 0.01;
  RangePair pair(own);
  pair.range(10);
  const double clock_m2 = std::pow(0.01 * 1500, 2);
  // p - p^2 / (p + clock + fix + range).
  EXPECT_NEAR(variances_of(pair.bound, 100).x(), 100 - 1e4 / (100 + clock_m2 + 4 + 0.01), 1e-3);
}

TEST(TeamBound, WithoutTheErrorsThatAreKnownIsSmaller) {
  VehicleErrors own = submarine();
  own.clock_offset_std_s = 0.01;
  own.heading.slow = {{0.05, 0, 0}, {0.02, 0, 20}};
  TeamBound::Options options = start_of(10);
  const auto errors = [&] { return TeamBound({own}, 0, options).covariance().rows(); };
  EXPECT_EQ(errors(), 2 + 1 + 2);
  options.known = {TeamBound::Known::clock};
  EXPECT_EQ(errors(), 2 + 2);
  options.known = {TeamBound::Known::clock, TeamBound::Known::heading_drift};
  EXPECT_EQ(errors(), 2 + 1);
}

TEST(TeamBound, UsesASightingInTheFrameOfTheObserver) {
  VehicleErrors rover;
  rover.motion = Motion::wheels;
  rover.sightings = VehicleErrors::Sightings{{}, 0.15};
  TeamBound::Options options = start_of(10);
  options.start_heading_std_rad = 0.02;
  TeamBound bound({rover, beacon(0.5)}, 0, options);
  travel(bound, {{0, 0, 0}, {20, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}, 0, 10);
  bound.add_fix(seconds(5), 1);
  bound.add_sighting(seconds(5.1), 0, 1);
  const Eigen::Vector2d variances = variances_of(bound, 10);
  const auto updated = [](double r) { return 100 - 1e4 / (100 + r); };
  EXPECT_NEAR(variances.x(), updated(0.25 + 0.0225), 1e-6);
  // An error of the heading is 20 m times 0.02 rad across.
  EXPECT_NEAR(variances.y(), updated(0.25 + 0.0225 + 0.16), 1e-6);
}

TEST(TeamBound, ASightByUSBLFromAboveHasErrorsInBothDirections) {
  VehicleErrors craft = beacon(0.5);
  craft.usbl = VehicleErrors::Usbl{
      {}, {.range_std_m = 0.4, .across_std_rad = 0.02, .elevation_std_rad = 0.03, .heading_std_rad = 0, .hearing = {}}};
  TeamBound bound({submarine(), craft}, 0, start_of(10));
  travel(bound, {{0, 0, -100}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}, 0, 10);
  bound.add_fix(seconds(5), 1);
  bound.add_usbl(seconds(5.1), 1, 0);
  const Eigen::Vector2d variances = variances_of(bound, 10);
  const auto updated = [](double r) { return 100 - 1e4 / (100 + r); };
  EXPECT_NEAR(variances.x(), updated(0.25 + std::pow(100 * 0.03, 2)), 1e-6);
  EXPECT_NEAR(variances.y(), updated(0.25 + std::pow(100 * 0.02, 2)), 1e-6);
}

TEST(TeamBound, UsesASightByUSBLWithItsErrorsAlongAndAcross) {
  VehicleErrors craft = beacon(0.5);
  craft.usbl = VehicleErrors::Usbl{
      {},
      {.range_std_m = 0.4, .across_std_rad = 0.02, .elevation_std_rad = 0.03, .heading_std_rad = 0.01, .hearing = {}}};
  TeamBound bound({submarine(), craft}, 0, start_of(10));
  travel(bound, {{0, 0, -30}, {40, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}, 0, 10);
  bound.add_fix(seconds(5), 1);
  bound.add_usbl(seconds(5.1), 1, 0);
  const Eigen::Vector2d variances = variances_of(bound, 10);
  const auto updated = [](double r) { return 100 - 1e4 / (100 + r); };
  // 40 m away and 30 m below: 50 m, cos 0.8, sin 0.6.
  EXPECT_NEAR(variances.x(), updated(0.25 + std::pow(0.8 * 0.4, 2) + std::pow(30 * 0.03, 2)), 1e-6);
  // The direction turns by 0.02 at 50 m, the heading by 0.01 at 40 m.
  EXPECT_NEAR(variances.y(), updated(0.25 + std::pow(50 * 0.02, 2) + std::pow(40 * 0.01, 2)), 1e-6);
  EXPECT_EQ(bound.result().sightings, 1);
}

TEST(TeamBound, OfRobotsThatSeeEachOtherIsThatOfTheirInformation) {
  VehicleErrors robot;
  robot.motion = Motion::wheels;
  robot.along_noise_mprts = 0.05;
  robot.turn_noise_radprts = 0.03;
  robot.sightings = VehicleErrors::Sightings{{}, 0.1};
  TeamBound::Options options = start_of(0.2);
  options.start_heading_std_rad = 0.05;
  TeamBound bound({robot, robot}, 0, options);
  const Eigen::Vector3d from[2] = {{0, 0, 0}, {3, 4, 0}}, v[2] = {{0.1, 0, 0}, {-0.05, 0.1, 0}};
  travel(bound, {from[0], from[1]}, {v[0], v[1]}, 0, 60);
  for (int t = 5; t <= 60; t += 5) bound.add_sighting(seconds(t), t % 2, 1 - t % 2);
  // The same by the information matrix of (east, north, heading) of both, in steps of 0.2 s.
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Matrix6 P = Matrix6::Zero();
  P.diagonal() << 0.04, 0.04, 0.0025, 0.04, 0.04, 0.0025;
  for (int step = 1; step <= 300; ++step) {
    Matrix6 F = Matrix6::Identity(), Q = Matrix6::Zero();
    for (int i = 0; i < 2; ++i) {
      F(3 * i, 3 * i + 2) = -0.2 * v[i].y();
      F(3 * i + 1, 3 * i + 2) = 0.2 * v[i].x();
      Q(3 * i, 3 * i) = 0.0025 * 0.2;  // they face east
      Q(3 * i + 2, 3 * i + 2) = 0.0009 * 0.2;
    }
    P = F * P * F.transpose() + Q;
    if (step % 25 != 0) continue;
    const int own = step / 25 * 5 % 2;
    const Eigen::Vector3d d = from[1 - own] - from[own] + 0.2 * step * (v[1 - own] - v[own]);
    Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
    H.middleCols<2>(3 * own) = -Eigen::Matrix2d::Identity();
    H.middleCols<2>(3 - 3 * own) = Eigen::Matrix2d::Identity();
    H.col(3 * own + 2) << d.y(), -d.x();
    P = (P.inverse() + 100 * H.transpose() * H).inverse().eval();
  }
  const Eigen::Vector2d variances = variances_of(bound, 60);
  EXPECT_NEAR(variances.x(), P(0, 0), 1e-9);
  EXPECT_NEAR(variances.y(), P(1, 1), 1e-9);
}

TEST(TeamBound, ContinuesFromASavedState) {
  RangePair pair;
  pair.range(10);
  pair.range(20, 5);
  pair.bound.advance(seconds(21));  // a packet is under way
  auto saver = sim::StateArchive::saver();
  saver(pair.bound);
  const sim::Bytes saved = saver.take_bytes();
  RangePair other;
  other.range(50);
  auto restorer = sim::StateArchive::restorer(saved);
  restorer(other.bound);
  EXPECT_EQ(restorer.bytes_left(), 0u);
  EXPECT_EQ(other.bound.result().sum_m2, pair.bound.result().sum_m2);
  EXPECT_EQ(other.bound.result().ranges, 2);
}

TEST(TeamBound, RefusesTheStateOfAnotherTeam) {
  RangePair pair;
  auto saver = sim::StateArchive::saver();
  saver(pair.bound);
  const sim::Bytes saved = saver.take_bytes();
  TeamBound other({submarine()}, 0, start_of(10));
  auto restorer = sim::StateArchive::restorer(saved);
  EXPECT_THROW(restorer(other), sim::SnapshotError);
}

TEST(TeamBound, LeavesOutWhatIsTooLate) {
  RangePair pair;
  pair.bound.advance(seconds(50));
  pair.range(10);
  pair.bound.add_fix(seconds(10), 1);
  EXPECT_EQ(pair.bound.result().ranges, 0);
  EXPECT_EQ(pair.bound.result().fixes, 0);
}

TEST(TeamBound, OfAVehicleThatWasPlacedElsewhereHasNotGrown) {
  VehicleErrors errors = submarine();
  errors.speed_scale_std = 0.03;
  TeamBound bound({errors}, 0, start_of(1));
  bound.move(seconds(0), {{}}, true);
  bound.move(seconds(0.2), {{{1000, 0, 0}, 0}}, true);
  EXPECT_NEAR(variances_of(bound, 0.2).x(), 1, 1e-12);
}

}  // namespace
