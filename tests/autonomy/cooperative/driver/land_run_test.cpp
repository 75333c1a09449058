// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_run.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "autonomy/cooperative/driver/estimate_files.hpp"

namespace {

using namespace navigation;

constexpr int end_s = 60;

/// Record of two robots that drive east in parallel for a minute, 2 m apart.  Odometry of the first reads 5 % too
/// little.  Each second the first sees the second, whose position at the start is known; the errors are those of the
/// set-up.
class LandRunOfTwo : public testing::Test {
 protected:
  LandRunOfTwo() {
    auto team = std::make_shared<NavTeam>();
    for (int i = 0; i < 2; ++i) {
      NavVehicle& robot = team->vehicles.emplace_back();
      robot.name = "robot" + std::to_string(i + 1);
      robot.errors.heading_bias_rad = 0.01;
      LandVehicle& land = robot.land.emplace();
      land.X_WV.translation().y() = 2 * i;
      land.along_density = i == 0 ? 0.04 : 1e-6;
      land.seen_std_m = 0.05;
      land.swarm = NavDevice{};
    }
    record_.team = team;
    record_.truth.resize(2);
    record_.end_us = end_s * second;
    for (int t = 0; t <= end_s; ++t)
      for (int i = 0; i < 2; ++i) {
        record_.truth[static_cast<std::size_t>(i)].push_back({t * second, {0.5 * t, 2.0 * i, 0}});
        shoal::odometry_t odometry{};
        odometry.utime = t * second;
        odometry.x_m = (i == 0 ? 0.95 : 1) * 0.5 * t;
        record_.items.push_back({t * second, i, odometry});
      }
  }
  static constexpr std::int64_t second = 1'000'000;

  void relative(int time_s) {
    shoal::swarm_position_t seen{};
    seen.utime = time_s * second;
    seen.count = 1;
    seen.vehicle = {"robot2"};
    seen.relative_m = {{0, 2, 0}};
    seen.absolute_m = {{0, 0, 0}};
    record_.items.push_back({time_s * second, 0, seen});
  }
  /// Robot 2 sends a message that robot 1 receives 0.4 s later.
  void message(int time_s) {
    shoal::modem_send_t send{};
    send.data = {static_cast<std::uint8_t>(time_s)};
    record_.items.push_back({time_s * second, 1, send});
    shoal::modem_received_t packet{};
    packet.utime = time_s * second + 400'000;
    packet.source = "robot2";
    packet.data = send.data;
    record_.items.push_back({packet.utime, 0, packet});
  }
  OfflineRun run(const std::string& algorithm) {
    return run_offline(record_, algorithm_named(algorithm), std::vector<NavOptions>(2));
  }
  double error_m(const OfflineRun& run) { return score_of(run.estimates[0], record_.truth[0], 0, 30 * second).rms_m; }

  NavRecord record_;
};

TEST_F(LandRunOfTwo, DeadReckoningKeepsTheErrorOfTheWheels) {
  const OfflineRun dr = run("dr");
  ASSERT_EQ(dr.estimates[0].size(), 2U * end_s + 1);
  EXPECT_NEAR(dr.estimates[0].back().message.position_m[0], 0.95 * 0.5 * end_s, 1e-6);
  EXPECT_NEAR(dr.estimates[1].back().message.position_m[0], 0.5 * end_s, 1e-6);
  EXPECT_NEAR(dr.estimates[1].back().message.covariance_m2[0], 0.01 + 1e-6 * end_s, 1e-6);
}

TEST_F(LandRunOfTwo, AnAlgorithmWithoutAUseOfSightsIsRefused) {
  for (const char* algorithm : {"iu", "osm", "fls"}) EXPECT_THROW(run(algorithm), std::invalid_argument) << algorithm;
}

TEST_F(LandRunOfTwo, TheFilterOfTheRoversIsForLandOnly) {
  EXPECT_EQ(run("coop_rover").estimates[0].size(), 2U * end_s + 1);
  EXPECT_FALSE(algorithm_named("coop_rover").at_sea);
  EXPECT_TRUE(algorithm_named("naive").at_sea);
  record_.team = std::make_shared<NavTeam>();
  EXPECT_THROW(run_offline(record_, algorithm_named("coop_rover"), {}), std::invalid_argument);
}

TEST_F(LandRunOfTwo, ASightHasThePayloadOfThatInstantWithoutRadio) {
  for (int t = 1; t <= end_s; ++t) relative(t);
  const double dr_m = error_m(run("dr"));
  for (const char* algorithm : {"naive", "luft", "cekf"}) {
    const OfflineRun all = run(algorithm);
    EXPECT_EQ(all.ranges, end_s) << algorithm;
    EXPECT_LT(error_m(all), 0.2 * dr_m) << algorithm;
  }
  EXPECT_LT(error_m(run("ci")), 0.5 * dr_m);
  EXPECT_EQ(run("naive").frames_said, end_s);
}

TEST_F(LandRunOfTwo, ASightAfterAMessageHasItsPayloadMovedByWhatTheSenderTraveled) {
  for (int t = 1; t <= end_s; ++t) relative(t);
  for (int t = 0; t < end_s; ++t) message(t);
  const OfflineRun naive = run("naive");
  EXPECT_EQ(naive.frames_said, end_s);
  // The position in the payload is a second old: 0.5 m.
  EXPECT_LT(error_m(naive), 0.1);
}

TEST_F(LandRunOfTwo, WithoutMessagesToASightItHasNoPayload) {
  for (int t = 1; t <= end_s; ++t) relative(t);
  // One that no other robot receives: they have radio.
  record_.items.push_back({0, 1, shoal::modem_send_t{}});
  EXPECT_EQ(run("naive").frames_said, 1);
  EXPECT_DOUBLE_EQ(error_m(run("naive")), error_m(run("dr")));
  EXPECT_LT(error_m(run("cekf")), 0.2 * error_m(run("dr")));
}

TEST_F(LandRunOfTwo, SightsThatAreFarTooWrongAreRefusedAlsoInABurst) {
  for (int t = 1; t <= end_s; ++t) relative(t);
  const std::vector<std::string> algorithms = {"naive", "ci", "luft", "cekf"};
  std::vector<double> right_m;
  for (const std::string& algorithm : algorithms) right_m.push_back(error_m(run(algorithm)));
  // Robot 1 takes something 9 m to its left for robot 2, ten times a second as cameras do.
  for (int i = 0; i < 10; ++i) {
    relative(31);
    std::get<shoal::swarm_position_t>(record_.items.back().message).relative_m[0][1] = 9;
  }
  for (std::size_t i = 0; i < algorithms.size(); ++i)
    EXPECT_NEAR(error_m(run(algorithms[i])), right_m[i], 1e-9) << algorithms[i];
}

TEST_F(LandRunOfTwo, ARunIsTheSameAgain) {
  for (int t = 1; t <= end_s; t += 3) relative(t);
  for (const char* algorithm : {"ci", "luft"}) {
    const OfflineRun first = run(algorithm), second_run = run(algorithm);
    for (std::size_t i = 0; i < first.estimates[0].size(); ++i) {
      EXPECT_EQ(first.estimates[0][i].message.position_m[0], second_run.estimates[0][i].message.position_m[0]);
      EXPECT_EQ(first.estimates[0][i].message.covariance_m2[4], second_run.estimates[0][i].message.covariance_m2[4]);
    }
  }
}

}  // namespace
