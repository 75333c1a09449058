// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiment/score/link_counts.hpp"
#include "experiment/score/metric.hpp"
#include "experiment/score/scoring.hpp"
#include "shoal/pose_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/score/metric_worlds.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using namespace metric_worlds;

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

}  // namespace
