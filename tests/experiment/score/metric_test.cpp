// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "experiment/score/link_counts.hpp"
#include "experiment/score/scoring.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

/// A rover that stands at (1, 2), 3 m west of a crate; `metrics`: the list.
std::string metric_world(const std::string& metrics) {
  return test::rover_world(
      "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
      "wheel_radius_m: 0.1, track_m: 0.5}\n",
      "  - {name: crate, fixed: true, position_m: [4.5, 2, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n",
      "    position_m: [1, 2, 0]\n",
      "zones: [{name: goal, shape: box, position_m: [3, 2, 0], size_m: [1, 4, 4]}]\n"
      "metrics:\n" +
          metrics);
}

struct MetricWorld {
  explicit MetricWorld(const std::string& metrics) : test(metric_world(metrics)), scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  void drive(double forward_mps) {
    shoal::twist_command_t command{};
    command.forward_mps = forward_mps;
    test.send("r1.drive.cmd", command);
  }
  sim::Vector3d position_m() const { return test.world.find_vehicle("r1")->X_WV().translation(); }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  /// An estimate that is off by `error_m`, for now plus `ahead_s`.
  void estimate(const sim::Vector3d& error_m, const Eigen::Matrix3d& covariance_m2, double ahead_s = 0) {
    shoal::estimate_t message{};
    message.utime = test.world.epoch_us() + (test.world.now() + sim::from_seconds(ahead_s)).count();
    const sim::Vector3d p = position_m() + error_m;
    for (int i = 0; i < 3; ++i) message.position_m[i] = p[i];
    for (int i = 0; i < 9; ++i) message.covariance_m2[i] = covariance_m2(i / 3, i % 3);
    message.clock_error_s = std::nan("");
    test.send("est", message);
  }

  test::TestWorld test;
  experiment::Scoring scoring;
};

Eigen::Matrix3d some_covariance() {
  Eigen::Matrix3d P;
  P << 4, 1.5, 0.2, 1.5, 1, 0.1, 0.2, 0.1, 9;
  return P;
}

constexpr const char* consistency = "  - {name: c, type: consistency, vehicle: r1, channel: est}\n";

// A rover that stands still may creep by some 0.01 mm.
constexpr double creep_m = 1e-4;

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

TEST(PositionError, IsHorizontalUnlessThreeDimensionsAreAskedFor) {
  MetricWorld world(
      "  - {name: flat, type: position_error, vehicle: r1, channel: est}\n"
      "  - {name: full, type: position_error, vehicle: r1, channel: est, dimensions: 3}\n");
  world.run_for(0.1);
  world.estimate({3, 4, 12}, some_covariance());
  world.run_for(0.01);
  EXPECT_NEAR(world.figure("flat.final_m"), 5, creep_m);
  EXPECT_NEAR(world.figure("full.final_m"), 13, creep_m);  // 3, 4, 12, 13
  // What the estimate says of its errors: the root of the sum of the variances.
  const auto tracks = world.scoring.tracks();
  EXPECT_NEAR(tracks.at(0).samples->at(0).sigma_m, std::sqrt(4.0 + 1.0), 1e-12);
  EXPECT_NEAR(tracks.at(1).samples->at(0).sigma_m, std::sqrt(4.0 + 1.0 + 9.0), 1e-12);
}

TEST(PositionError, TakesAnEstimateWithoutAUsableCovariance) {
  MetricWorld world("  - {name: flat, type: position_error, vehicle: r1, channel: est}\n");
  world.run_for(0.1);
  world.estimate({3, 4, 0}, Eigen::Matrix3d::Zero());
  world.run_for(0.01);
  EXPECT_NEAR(world.figure("flat.final_m"), 5, creep_m);
  EXPECT_EQ(world.scoring.bad_messages(), 0);
}

TEST(PositionError, ShowsHowLongThereWasNoEstimate) {
  MetricWorld world("  - {name: e, type: position_error, vehicle: r1, channel: est, from_s: 0.5}\n");
  world.run_for(1.5);
  EXPECT_NEAR(world.figure("e.max_gap_s"), 1, 1e-9);  // none yet
  for (const double pause_s : {0.4, 1.6, 0.2}) {
    world.estimate({1, 0, 0}, some_covariance());
    world.run_for(pause_s);
  }
  EXPECT_NEAR(world.figure("e.max_gap_s"), 1.6, 1e-9);
  world.run_for(2);
  EXPECT_NEAR(world.figure("e.max_gap_s"), 2.2, 1e-9);  // since the last
}

TEST(PositionError, SaysOnceWhatIsWrongAndThenHowOften) {
  MetricWorld world("  - {name: e, type: position_error, vehicle: r1, channel: est}\n");
  const test_support::LogCapture log;
  world.run_for(0.1);
  for (int i = 0; i < 300; ++i) {
    world.estimate({1, 0, 0}, some_covariance(), -20);
    if (i % 100 == 99) world.run_for(0.01);
  }
  world.estimate({1, 0, 0}, some_covariance());
  world.run_for(0.01);
  const std::string reported = log.text();
  EXPECT_EQ(world.scoring.bad_messages(), 300);
  EXPECT_EQ(std::count(reported.begin(), reported.end(), '\n'), 2) << reported;
  EXPECT_NE(reported.find("metric 'e': est: 'utime' is not within the last 10 s"), reported.npos) << reported;
  EXPECT_NE(reported.find("metric 'e': 300 messages in a row were ignored"), reported.npos) << reported;
}

TEST(PositionError, SaysOnceWhatIsWrongBetweenGoodOnesAndStopsAtAHundred) {
  const test_support::LogCapture log;
  std::ptrdiff_t of_the_world = 0;  // that no device of it publishes on 'est'
  const auto lines = [&] {
    const std::string reported = log.text();
    return std::count(reported.begin(), reported.end(), '\n') - of_the_world;
  };
  {
    MetricWorld world("  - {name: e, type: position_error, vehicle: r1, channel: est}\n");
    of_the_world = lines();
    world.run_for(0.1);
    for (int i = 0; i < 300; ++i) {
      world.estimate({1, 0, 0}, some_covariance(), i % 2 == 0 ? -20 : 0);
      world.run_for(0.001);
    }
    EXPECT_EQ(lines(), 1) << log.text();
    for (int i = 0; i < 600; ++i) {
      world.estimate({i % 3 == 0 ? std::nan("") : 0, 0, 0}, some_covariance(), i % 3 == 1 ? -20 : 0);
      world.run_for(0.001);
    }
    EXPECT_EQ(lines(), 100);
  }
  EXPECT_EQ(lines(), 101);
  EXPECT_NE(log.text().find("metric 'e': 550 messages were ignored in all"), std::string::npos) << log.text();
}

TEST(PositionError, WarnsAtTheEndThatNothingCame) {
  MetricWorld world(
      "  - {name: e, type: position_error, vehicle: r1, channel: est}\n  - {name: late, type: position_error, vehicle: "
      "r1, channel: est, from_s: 5}\n");
  const auto warnings = [&] {
    const test_support::LogCapture log;
    sim::Warnings at_the_end;
    world.scoring.warn_of_silence(at_the_end);
    return at_the_end.lines();
  };
  world.run_for(0.1);
  ASSERT_EQ(warnings().size(), 2u);
  EXPECT_NE(warnings()[0].find("metric 'e': no estimate was received on 'est': its figures are not numbers"),
            std::string::npos);
  EXPECT_NE(warnings()[1].find("metric 'late': the run ended at 0.1 s, before from_s, 5 s"), std::string::npos);
  world.estimate({1, 0, 0}, some_covariance(), -20);
  world.run_for(0.01);
  EXPECT_NE(warnings()[0].find("none of 1 message on 'est' could be used"), std::string::npos);
  world.estimate({1, 0, 0}, some_covariance());
  world.run_for(0.01);
  EXPECT_EQ(warnings().size(), 1u) << "the other one still waits";
}

TEST(PositionError, SaysAtTheEndHowManyWereIgnored) {
  const test_support::LogCapture log;
  {
    MetricWorld world("  - {name: e, type: position_error, vehicle: r1, channel: est}\n");
    world.run_for(0.1);
    for (int i = 0; i < 30; ++i) world.estimate({1, 0, 0}, some_covariance(), -20);
    world.run_for(0.01);
  }
  EXPECT_NE(log.text().find("metric 'e': 30 messages in a row were ignored"), std::string::npos) << log.text();
}

TEST(PositionError, PerDistanceIsOfTheWayThatWasTraveled) {
  MetricWorld world("  - {name: e, type: position_error, vehicle: r1, channel: est}\n");
  world.drive(0.5);
  world.run_for(3);
  world.estimate({0, 0.1, 0}, some_covariance());
  const double distance_m = world.position_m().x() - 1;  // it goes straight
  world.run_for(0.001);
  EXPECT_GT(distance_m, 1);
  EXPECT_NEAR(world.figure("e.per_distance_percent"), 100 * 0.1 / distance_m, 0.01);
}

TEST(PositionError, OfAClockThatIsAheadWaitsForItsTime) {
  MetricWorld world("  - {name: e, type: position_error, vehicle: r1, channel: est}\n");
  world.drive(0.5);
  world.run_for(2);
  const double here_m = world.position_m().x();
  world.estimate({0, 0, 0}, some_covariance(), 0.4);
  world.run_for(0.3);
  EXPECT_EQ(world.figure("e.samples"), 0);
  EXPECT_EQ(world.scoring.bad_messages(), 0);
  world.run_for(0.1);
  ASSERT_EQ(world.figure("e.samples"), 1);
  // It is compared with where the rover was 0.4 s later.
  EXPECT_NEAR(world.figure("e.final_m"), world.position_m().x() - here_m, 1e-3);
  EXPECT_GT(world.figure("e.final_m"), 0.15);
}

TEST(PositionError, IsOfTheTrueTimeHoweverFarTheClockIsOff) {
  for (const char* clock : {"clock: {offset_s: 90}", "clock: {offset_s: -90}", "clock: {offset_s: 3e7}",
                            "clock: {offset_s: -3e7, drift_ppm: 20}"}) {
    test::TestWorld test(test::modem_sea({{"a", "[1, 2, -20]", "{name: modem, type: acoustic_modem}", clock}},
                                         "metrics: [{name: e, type: position_error, vehicle: a, channel: est}]\n"));
    experiment::Scoring scoring(test.world);
    const sim::Vehicle& vehicle = *test.world.find_vehicle("a");
    const auto step = [&] {
      test.world.step();
      scoring.after_step();
    };
    while (test.world.now() < sim::Time{2'000'000}) step();
    const sim::Time at{1'600'000};
    shoal::pose_t message{};
    message.utime = test.world.epoch_us() + vehicle.clock().reading(at).count();
    const sim::Vector3d p = vehicle.X_WV().translation();
    message.pos[0] = p.x() + 3, message.pos[1] = p.y() + 4;
    test.send("est", message);
    step();
    EXPECT_EQ(scoring.bad_messages(), 0) << clock;
    ASSERT_EQ(scoring.figures().at("e.samples"), 1) << clock;
    EXPECT_NEAR(scoring.figures().at("e.final_m"), 5, creep_m) << clock;  // 3, 4, 5
    EXPECT_NEAR(scoring.tracks().at(0).samples->at(0).time_s, sim::to_seconds(at), 2e-6) << clock;
    // A stamp by true time, which the vehicle does not know, is far off.
    for (const std::int64_t utime :
         {test.world.epoch_us() + test.world.now().count(), std::numeric_limits<std::int64_t>::min(),
          std::numeric_limits<std::int64_t>::max()}) {
      message.utime = utime;
      test.send("est", message);
    }
    step();
    EXPECT_EQ(scoring.bad_messages(), 3) << clock;
  }
}

TEST(Distance, IsTheLengthOfTheWay) {
  MetricWorld world(
      "  - {name: all, type: distance, vehicle: r1}\n"
      "  - {name: late, type: distance, vehicle: r1, from_s: 2}\n");
  world.drive(0.5);
  world.run_for(2);
  const double half_m = world.position_m().x() - 1;
  world.drive(-0.5);
  world.run_for(2);
  const double back_m = world.position_m().x() - 1;
  world.run_for(0.001);
  // Forth and back; while it brakes it still goes forth, so the way is longer than the two differences.
  EXPECT_GT(half_m, 0.8);
  EXPECT_GE(world.figure("all.travelled_m"), half_m + (half_m - back_m));
  EXPECT_LT(world.figure("all.travelled_m"), half_m + (half_m - back_m) + 0.3);
  EXPECT_NEAR(world.figure("late.travelled_m"), world.figure("all.travelled_m") - half_m, 0.01);
}

TEST(MissionTime, IsTheFirstTimeInsideAZoneOrNearAPlace) {
  MetricWorld world(
      "  - {name: zone, type: mission_time, when: r1 inside goal}\n"
      "  - {name: place, type: mission_time, vehicle: r1, position_m: [2, 2, 0], radius_m: 0.25}\n"
      "  - {name: never, type: mission_time, vehicle: r1, position_m: [9, 9, 0], radius_m: 1}\n"
      "  - {name: talk, type: mission_time, when: message on hello}\n");
  world.drive(0.5);
  double zone_s = -1, place_s = -1;
  for (int i = 0; i < 500; ++i) {
    world.run_for(0.01);
    const double x_m = world.position_m().x();
    const double now_s = sim::to_seconds(world.test.world.now());
    if (zone_s < 0 && x_m >= 2.5) zone_s = now_s;
    if (place_s < 0 && x_m >= 1.75) place_s = now_s;
  }
  world.test.send("hello", shoal::twist_command_t{});
  world.run_for(0.001);
  EXPECT_NEAR(world.figure("zone.time_s"), zone_s, 0.01);  // of the look every 0.01 s
  EXPECT_NEAR(world.figure("place.time_s"), place_s, 0.01);
  EXPECT_TRUE(std::isnan(world.figure("never.time_s")));
  EXPECT_DOUBLE_EQ(world.figure("talk.time_s"), 5.001);
}

TEST(Collisions, CountContactsThatBeginButNotWithTheGround) {
  MetricWorld world(
      "  - {name: all, type: collisions}\n"
      "  - {name: crate, type: collisions, vehicle: r1, with: crate}\n"
      "  - {name: ground, type: collisions, vehicle: r1, with: ground}\n"
      "  - {name: late, type: collisions, vehicle: r1, from_s: 1000}\n");
  world.run_for(1);
  EXPECT_EQ(world.figure("all.count"), 0);
  EXPECT_TRUE(std::isnan(world.figure("all.first_s")));
  EXPECT_EQ(world.figure("ground.count"), 1);  // named, planes count as well
  world.drive(1);
  world.run_for(5);  // 2.8 m to the crate
  EXPECT_EQ(world.figure("all.count"), 1);
  EXPECT_EQ(world.figure("crate.count"), 1);
  EXPECT_GT(world.figure("crate.first_s"), 1 + 2.8 / 1.0);
  world.drive(-1);
  world.run_for(2);
  world.drive(1);
  world.run_for(5);
  EXPECT_EQ(world.figure("crate.count"), 2);
  EXPECT_TRUE(std::isnan(world.figure("late.count"))) << "nothing was counted before from_s";
}

TEST(Collisions, DoNotChangeTheRun) {
  MetricWorld with("  - {name: all, type: collisions}\n");
  MetricWorld without("  - {name: distance, type: distance, vehicle: r1}\n");
  for (MetricWorld* world : {&with, &without}) {
    world->drive(1);
    world->run_for(4);
  }
  EXPECT_EQ(with.figure("all.count"), 1);
  EXPECT_EQ(with.test.world.state().run_hash(), without.test.world.state().run_hash());
}

TEST(Messages, AreCountedWithTheirBytes) {
  MetricWorld world("  - {name: m, type: messages, channel: hello, from_s: 0.2}\n");
  world.run_for(0.1);
  world.test.send("hello", shoal::twist_command_t{});
  world.run_for(0.2);
  world.test.send("hello", shoal::twist_command_t{});
  world.test.bus.publish("hello", sim::Bytes(5), world.test.world.now());
  world.run_for(0.01);
  EXPECT_EQ(world.figure("m.count"), 2);
  EXPECT_EQ(world.figure("m.bytes"), 5 + static_cast<double>(shoal::encode(shoal::twist_command_t{}).size()));
  EXPECT_NEAR(world.figure("m.first_s"), 0.301, 1e-9);
}

TEST(Delivery, OfAWorldWithoutModemsHasNoRatio) {
  MetricWorld world("  - {name: d, type: delivery}\n");
  world.run_for(0.01);
  EXPECT_EQ(world.figure("d.sent"), 0);
  EXPECT_EQ(world.figure("d.received"), 0);
  EXPECT_TRUE(std::isnan(world.figure("d.ratio")));
  for (const std::string& cause : experiment::loss_causes()) EXPECT_EQ(world.figure("d.lost_" + cause), 0);
}

TEST(Delivery, CountsWhatModemsSentAndWhatTheOthersReceived) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  test::TestWorld test(
      test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}, {"c", "[0, 600, -20]", modem}},
                      "metrics:\n"
                      "  - {name: all, type: delivery}\n"
                      "  - {name: a, type: delivery, vehicle: a}\n"
                      "  - {name: c, type: delivery, vehicle: c, device: modem}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.run_for(5);
  auto figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 1);
  EXPECT_EQ(figures.at("all.bytes_sent"), 5);
  EXPECT_EQ(figures.at("all.received"), 2);  // b and c
  EXPECT_EQ(figures.at("all.ratio"), 1);
  EXPECT_EQ(figures.at("a.sent"), 1);
  EXPECT_TRUE(std::isnan(figures.at("a.ratio")));
  EXPECT_EQ(figures.at("c.sent"), 0);
  EXPECT_EQ(figures.at("c.received"), 1);

  // Each is sending when the other's sound comes, 0.2 s later.
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.send("b.modem.cmd", test::bytes_to("hello"));
  test.run_for(5);
  figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 3);
  EXPECT_EQ(figures.at("all.lost_half_duplex"), 2);
  EXPECT_EQ(figures.at("a.lost_half_duplex"), 1);
  EXPECT_EQ(figures.at("a.ratio"), 0);
  double lost = 0;
  for (const std::string& cause : experiment::loss_causes()) lost += figures.at("all.lost_" + cause);
  EXPECT_EQ(figures.at("all.lost"), lost);
  EXPECT_EQ(figures.at("all.ratio"), figures.at("all.received") / (figures.at("all.received") + lost));
}

/// far cannot receive a, near can.
TEST(Delivery, IsOfWhatWasSentToAModem) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  test::TestWorld test(test::modem_sea(
      {{"a", "[0, 0, -20]", modem}, {"near", "[300, 0, -20]", modem}, {"far", "[200000, 0, -20]", modem}},
      "metrics:\n  - {name: all, type: delivery}\n  - {name: far, type: delivery, vehicle: far}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.modem.cmd", test::bytes_to("hello", "near"));
  test.run_for(5);
  EXPECT_EQ(scoring.figures().at("all.ratio"), 1) << "nobody sent to the other one";
  EXPECT_TRUE(std::isnan(scoring.figures().at("far.ratio")));
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.send("a.modem.cmd", test::bytes_to("hello", "far"));
  test.run_for(10);
  EXPECT_EQ(scoring.figures().at("all.received"), 2);
  EXPECT_EQ(scoring.figures().at("all.lost_range"), 2);
  EXPECT_EQ(scoring.figures().at("all.ratio"), 0.5);
  EXPECT_EQ(scoring.figures().at("far.ratio"), 0);
}

TEST(Delivery, CountsWhatWasNotSent) {
  const std::string modem = "{name: modem, type: acoustic_modem, queue_messages: 2}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}},
                                       "metrics:\n  - {name: a, type: delivery, vehicle: a}\n"));
  experiment::Scoring scoring(test.world);
  for (int i = 0; i < 5; ++i) test.send("a.modem.cmd", test::bytes_to("hello"));
  test.run_for(10);
  EXPECT_EQ(scoring.figures().at("a.dropped"), 3);
  EXPECT_EQ(scoring.figures().at("a.sent"), 2);
  EXPECT_EQ(scoring.figures().at("a.unsent"), 0);
}

/// b is in range of a, c is not; d is out of the water that hides it.
TEST(Delivery, OfARadioModemCountsWhatCameAndWhatDidNot) {
  const std::string radio = "{name: radio, type: modem, range_m: 500}";
  test::TestWorld test(test::modem_sea(
      {{"a", "[0, 0, 2]", radio}, {"b", "[300, 0, 2]", radio}, {"c", "[600, 0, 2]", radio}, {"d", "[0, 9, -2]", radio}},
      "metrics:\n"
      "  - {name: all, type: delivery}\n"
      "  - {name: a, type: delivery, vehicle: a, device: radio}\n"
      "  - {name: b, type: delivery, vehicle: b, device: radio}\n"
      "  - {name: c, type: delivery, vehicle: c}\n"
      "  - {name: d, type: delivery, vehicle: d}\n"));
  experiment::Scoring scoring(test.world);
  EXPECT_TRUE(std::isnan(scoring.figures().at("all.ratio"))) << "nothing was sent";
  test.send("a.radio.cmd", test::bytes_to("hello"));
  test.run_for(1);
  test.send("a.radio.cmd", test::bytes_to("b only", "b"));
  test.run_for(1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("a.sent"), 2);
  EXPECT_EQ(figures.at("a.bytes_sent"), 11);
  EXPECT_TRUE(std::isnan(figures.at("a.ratio"))) << "nobody sent to it";
  EXPECT_EQ(figures.at("b.received"), 2);
  EXPECT_EQ(figures.at("b.ratio"), 1);
  EXPECT_EQ(figures.at("c.lost_range"), 1);
  EXPECT_EQ(figures.at("c.ratio"), 0);
  EXPECT_EQ(figures.at("d.lost_blocked"), 1);
  EXPECT_EQ(figures.at("all.ratio"), 0.5) << "two of four";
}

TEST(Delivery, OfALossyRadioLinkIsAboutItsProbability) {
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, 2]", "{name: radio, type: modem, loss_probability: 0.25}"},
                                        {"b", "[50, 0, 2]", "{name: radio, type: modem}"}},
                                       "metrics:\n  - {name: b, type: delivery, vehicle: b, device: radio}\n"));
  experiment::Scoring scoring(test.world);
  constexpr int messages = 2000;
  for (int i = 0; i < messages; ++i) {
    test.send("a.radio.cmd", test::bytes_to("x"));
    test.run_for(0.01);
  }
  test.run_for(0.1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("b.received") + figures.at("b.lost_link"), messages);
  // Five standard deviations of a share of so many draws.
  EXPECT_NEAR(figures.at("b.ratio"), 0.75, 5 * std::sqrt(0.25 * 0.75 / messages));
}

/// A vehicle with both: without a name it is about the acoustic ones, as it was.
TEST(Delivery, OfAVehicleWithBothIsAboutSoundUnlessItNamesTheRadio) {
  const std::string both = "{name: radio, type: modem, range_m: 500}, {name: modem, type: acoustic_modem}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -2]", both}, {"b", "[300, 0, -2]", both}},
                                       "metrics:\n  - {name: all, type: delivery}\n"
                                       "  - {name: b, type: delivery, vehicle: b}\n"
                                       "  - {name: r, type: delivery, vehicle: b, device: radio}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.radio.cmd", test::bytes_to("hello"));
  test.run_for(1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 0);
  EXPECT_TRUE(std::isnan(figures.at("b.ratio")));
  EXPECT_EQ(figures.at("r.ratio"), 0);
  EXPECT_EQ(figures.at("r.lost_blocked"), 1);
}

TEST(Delivery, ATransponderIsNoModem) {
  const std::string devices =
      "{name: radio, type: modem, range_m: 500}, {name: noise, type: noise_source}, "
      "{name: answers, type: transponder}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, 2]", devices}, {"b", "[300, 0, 2]", devices}},
                                       "metrics:\n  - {name: all, type: delivery}\n"
                                       "  - {name: b, type: delivery, vehicle: b}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.radio.cmd", test::bytes_to("hello"));
  test.run_for(1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 1);
  EXPECT_EQ(figures.at("all.received"), 1);
  EXPECT_EQ(figures.at("b.ratio"), 1);
}

TEST(Delivery, OfModemsThatHaveLeftIsStillAboutThem) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}},
                                       "metrics:\n  - {name: all, type: delivery}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.run_for(10);
  for (const char* name : {"a", "b"}) test.world.editor().remove_vehicle(name);
  EXPECT_EQ(scoring.figures().at("all.sent"), 1);
  EXPECT_EQ(scoring.figures().at("all.ratio"), 1);
}

/// A box that turns about its y axis at 1 rad/s, its nose going down, without gravity.
TEST(Tilt, ReportsMeanSpreadAndFallOfASteadyTurn) {
  test::TestWorld test(test::box_world(
      "        - {name: clock, type: clock}\n", "{step_s: 0.001, gravity_mps2: 0}",
      "metrics:\n  - {name: all, type: tilt, vehicle: r1}\n  - {name: late, type: tilt, vehicle: r1, from_s: 5}\n"));
  experiment::Scoring scoring(test.world);
  sim::Body& body = *test.world.find_vehicle("r1")->bodies().front().second;
  body.set_velocity_W({0, 0, 0}, {0, 1, 0});
  for (int step = 0; step < 1000; ++step) {
    test.world.step();
    scoring.after_step();
  }
  const auto figures = scoring.figures();
  constexpr double degrees = 180 / std::numbers::pi;
  // Leans from 0 to 1 rad, evenly: the mean is 1/2, the spread 1 / sqrt(12); 0.1 %: the steps, and a turn in steps.
  EXPECT_NEAR(figures.at("all.pitch_mean_deg"), 0.5 * degrees, 1e-3 * degrees);
  EXPECT_NEAR(figures.at("all.pitch_std_deg"), degrees / std::sqrt(12), 1e-3 * degrees);
  EXPECT_NEAR(figures.at("all.max_deg"), degrees, 1e-3 * degrees);
  EXPECT_NEAR(figures.at("all.fell_s"), std::numbers::pi / 4, 2e-3);
  for (const char* figure : {"pitch_mean_deg", "pitch_std_deg", "max_deg", "fell_s"})
    EXPECT_TRUE(std::isnan(figures.at(std::string("late.") + figure))) << figure;
}

TEST(BytesPerMeter, NeedsAnErrorThatBecameSmaller) {
  const std::string metrics =
      "  - {name: with, type: position_error, vehicle: r1, channel: est}\n"
      "  - {name: without, type: position_error, vehicle: r1, channel: est2}\n"
      "  - {name: cost, type: bytes_per_metre, metric: with, against: without}\n";
  MetricWorld world(metrics);
  world.run_for(0.1);
  world.estimate({3, 0, 0}, some_covariance());
  shoal::pose_t pose{};
  pose.utime = world.test.world.epoch_us() + world.test.world.now().count();
  pose.pos[0] = 1 + 8;
  pose.pos[1] = 2;
  world.test.send("est2", pose);
  world.run_for(0.01);
  EXPECT_NEAR(world.figure("cost.reduction_m"), 5, creep_m);
  EXPECT_EQ(world.figure("cost.bytes_per_metre"), 0);  // no one sent anything
  for (int i = 0; i < 9; ++i) world.estimate({30, 0, 0}, some_covariance());
  world.run_for(0.01);
  EXPECT_LT(world.figure("cost.reduction_m"), 0);
  EXPECT_TRUE(std::isnan(world.figure("cost.bytes_per_metre")));
}

TEST(Figures, OfAMetricAreThoseThatItsTypeNames) {
  MetricWorld world(
      "  - {name: a, type: position_error, vehicle: r1, channel: est}\n"
      "  - {name: b, type: position_error, vehicle: r1, channel: est2}\n"
      "  - {name: c, type: consistency, vehicle: r1, channel: est}\n"
      "  - {name: d, type: distance, vehicle: r1}\n"
      "  - {name: e, type: delivery, vehicle: r1}\n"
      "  - {name: f, type: bytes_per_metre, metric: a, against: b}\n"
      "  - {name: g, type: mission_time, when: any faster than 1}\n"
      "  - {name: h, type: collisions}\n"
      "  - {name: i, type: messages, channel: hello}\n"
      "  - {name: j, type: tilt, vehicle: r1}\n");
  std::vector<std::string> named, given;
  for (const sim::MetricConfig& metric : world.test.world.config().metrics)
    for (const std::string& figure : metric.figures()) named.push_back(figure);
  for (const auto& [figure, value] : world.scoring.figures()) given.push_back(figure);
  std::sort(named.begin(), named.end());
  EXPECT_EQ(named, given);
}

}  // namespace
