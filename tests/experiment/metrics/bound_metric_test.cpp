// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "experiment/score/scoring.hpp"
#include "shoal/pose_t.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace {

using testing::HasSubstr;

/// A submarine that starts with 10 m, and 100 m east of it a boat with GPS of 0.5 m; both stand still.
std::string bounded_world(const std::string& metrics) {
  return test::modem_sea(
      {{"auv", "[0, 0, -10]",
        "{name: dvl, type: dvl, scale_std: 0.03}, {name: modem, type: acoustic_modem}, "
        "{name: ahrs, type: ahrs, heading_noise: {bias_std: 0.05, gauss_markov_std: 0.02}}",
        "clock: {offset_s: 0.001}"},
       {"boat", "[100, 0, 0]",
        "{name: gps, type: gps, position_m: [0, 0, 1], rate_hz: 1, phase_s: 0, horizontal_noise: {gaussian_std: 0.5}}, "
        "{name: modem, type: acoustic_modem, position_m: [0, 0, -1]}",
        ""},
       {"rock", "[0, 50, -10]", "", ""}},
      "metrics:\n" + metrics);
}

constexpr const char* bound_with_clock =
    "  - {name: b, type: bound, vehicle: auv, start_std_m: 10, from_s: 1, known: [clock]}\n";

struct BoundedWorld {
  explicit BoundedWorld(const std::string& metrics) : test(bounded_world(metrics)), scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  /// Sends packets by the boat, one every 5 s, and waits for them.
  void send(int packets) {
    for (int i = 0; i < packets; ++i) {
      test.send("boat.modem.cmd", test::bytes_to("here"));
      run_for(5);
    }
  }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  test::TestWorld test;
  experiment::Scoring scoring;
};

TEST(BoundMetric, OfRangesIsThatOfTheirFixes) {
  BoundedWorld world(bound_with_clock);
  world.run_for(2);
  EXPECT_NEAR(world.figure("b.rms_m"), std::sqrt(200.0), 1e-6);
  world.send(3);
  EXPECT_EQ(world.figure("b.ranges"), 3);
  EXPECT_NEAR(world.figure("b.fixes"), 17, 1);  // one a second
  // Along the line each packet has the error of one fix; across it nothing is known.  Stamps have 1 us, 1.5 mm.
  EXPECT_NEAR(world.figure("b.final_m"), std::sqrt(100 + 1 / (0.01 + 3 / 0.25)), 1e-4);
  EXPECT_NEAR(world.figure("b.max_m"), std::sqrt(200.0), 1e-6);
}

TEST(BoundMetric, DoesNotKnowAConstantErrorOfTheClock) {
  BoundedWorld world("  - {name: b, type: bound, vehicle: auv, start_std_m: 10}\n");
  world.run_for(2);
  world.send(1);
  // 0.001 s is 1.5 m, and the unit vector is (100, 0, 9) / 100.4.
  const double u2 = 1e4 / (1e4 + 81);
  EXPECT_NEAR(world.figure("b.final_m"), std::sqrt(200 - 1e4 * u2 / (100 * u2 + 0.25 * u2 + 2.25)), 1e-3);
}

TEST(BoundMetric, OfATeamWithoutTheBoatHasNoRanges) {
  BoundedWorld world("  - {name: b, type: bound, vehicle: auv, start_std_m: 10, team: [auv]}\n");
  world.run_for(2);
  world.send(1);
  EXPECT_EQ(world.figure("b.ranges"), 0);
  EXPECT_NEAR(world.figure("b.final_m"), std::sqrt(200.0), 1e-6);
}

TEST(BoundMetric, CountsThePacketsOfItsScope) {
  BoundedWorld world(
      "  - {name: all, type: bound, vehicle: auv}\n"
      "  - {name: own, type: bound, vehicle: auv, of: received}\n"
      "  - {name: none, type: bound, vehicle: auv, of: alone}\n");
  world.send(1);
  world.test.send("auv.modem.cmd", test::bytes_to("here"));
  world.run_for(5);
  EXPECT_EQ(world.figure("all.ranges"), 2);
  EXPECT_EQ(world.figure("own.ranges"), 1);
  EXPECT_EQ(world.figure("none.ranges"), 0);
  // Ranges both ways reveal the error of the clock.
  EXPECT_LT(world.figure("all.final_m"), world.figure("own.final_m"));
  EXPECT_LT(world.figure("own.final_m"), world.figure("none.final_m"));
}

TEST(BoundMetric, CountsSightsByUSBLOfItsScope) {
  const std::string world = test::modem_sea(
      {{"auv", "[0, 0, -10]",
        "{name: dvl, type: dvl}, {name: ahrs, type: ahrs}, {name: modem, type: acoustic_modem}, "
        "{name: transponder, type: transponder}",
        ""},
       {"boat", "[40, 0, 0]",
        "{name: gps, type: gps, position_m: [0, 0, 1], rate_hz: 1, phase_s: 0, horizontal_noise: {gaussian_std: 0.5}}, "
        "{name: modem, type: acoustic_modem, position_m: [0, 0, -1]}, {name: ahrs, type: ahrs}, "
        "{name: usbl, type: usbl, position_m: [0, 0, -1], rate_hz: 10, ping_period_s: 1, range_noise: {gaussian_std: "
        "0.4}}",
        ""}},
      "metrics:\n"
      "  - {name: all, type: bound, vehicle: auv, start_std_m: 10}\n"
      "  - {name: own, type: bound, vehicle: auv, of: received, start_std_m: 10}\n"
      "  - {name: none, type: bound, vehicle: auv, of: alone, start_std_m: 10}\n");
  test::TestWorld test(world);
  experiment::Scoring scoring(test.world);
  while (test.world.now() < sim::from_seconds(20)) {
    test.world.step();
    scoring.after_step();
  }
  const auto figures = scoring.figures();
  EXPECT_NEAR(figures.at("all.sightings"), 20, 1);  // one a second
  EXPECT_EQ(figures.at("own.sightings"), figures.at("all.sightings"));
  EXPECT_EQ(figures.at("none.sightings"), 0);
  EXPECT_NEAR(figures.at("none.final_m"), std::sqrt(200.0), 1e-6);
  EXPECT_LT(figures.at("all.final_m"), 0.5);
}

TEST(BoundRatio, DividesTheErrorOfAnEstimate) {
  BoundedWorld world(std::string(bound_with_clock) +
                     "  - {name: e, type: position_error, vehicle: auv, channel: est, from_s: 1}\n"
                     "  - {name: r, type: bound_ratio, metric: e, bound: b}\n");
  world.run_for(2);
  EXPECT_TRUE(std::isnan(world.figure("r.ratio")));
  shoal::pose_t pose{};
  pose.utime = world.test.world.epoch_us() + world.test.world.now().count();
  pose.pos[1] = 7;
  world.test.send("est", pose);
  world.run_for(1);
  EXPECT_NEAR(world.figure("r.ratio"), world.figure("e.rms_m") / world.figure("b.rms_m"), 1e-12);
  EXPECT_NEAR(world.figure("r.ratio"), 7 / std::sqrt(200.0), 1e-3);
}

TEST(BoundMetric, GoesBackToWhatWasSaved) {
  BoundedWorld world(bound_with_clock);
  world.run_for(2);
  world.send(1);
  auto saver = sim::StateArchive::saver();
  world.scoring.visit_state(saver, experiment::History::whole);
  saver.end();
  const sim::Bytes saved = saver.take_bytes();
  const auto before = world.scoring.figures();
  world.send(2);
  EXPECT_NE(world.figure("b.rms_m"), before.at("b.rms_m"));
  auto restorer = sim::StateArchive::restorer(saved);
  world.scoring.visit_state(restorer, experiment::History::whole);
  restorer.end();
  EXPECT_EQ(world.scoring.figures(), before);
}

TEST(BoundMetric, RefusesWhatItCannotBound) {
  const auto error = [](const std::string& metrics) { return test::error_of_world(bounded_world(metrics)); };
  EXPECT_THAT(error("  - {name: b, type: bound, vehicle: rock}\n"),
              HasSubstr("metric 'b': vehicle 'rock' cannot localize itself: it needs gps, odometry, or dvl with ahrs "
                        "or compass"));
  EXPECT_THAT(error("  - {name: b, type: bound, vehicle: auv, team: [auv, rock]}\n"), HasSubstr("vehicle 'rock'"));
  EXPECT_THAT(error("  - {name: b, type: bound, vehicle: auv, known: [clok]}\n"),
              HasSubstr("'known' has the unknown error 'clok'"));
  EXPECT_THAT(error("  - {name: b, type: bound, vehicle: auv, team: [aux]}\n"), HasSubstr("aux"));
  EXPECT_EQ(error(bound_with_clock), "");
}

TEST(BoundRatio, RefusesErrorsOfAnotherPosition) {
  const auto error = [](const std::string& keys) {
    return test::error_of_world(bounded_world(std::string(bound_with_clock) +
                                              "  - {name: e, type: position_error, channel: est, " + keys +
                                              "}\n"
                                              "  - {name: r, type: bound_ratio, metric: e, bound: b}\n"));
  };
  EXPECT_EQ(error("vehicle: auv, from_s: 1"), "");
  EXPECT_THAT(error("vehicle: boat, from_s: 1"),
              HasSubstr("metric 'r': 'e' and 'b' must be of the same vehicle, got 'boat' and 'auv'"));
  EXPECT_THAT(error("vehicle: auv"), HasSubstr("metric 'r': 'e' and 'b' must have the same 'from_s', got 0 and 1"));
  EXPECT_THAT(error("vehicle: auv, from_s: 1, until_s: 2"),
              HasSubstr("metric 'r': 'e' must not have 'until_s', got 2: the bound covers the whole run"));
  EXPECT_THAT(error("vehicle: auv, from_s: 1, dimensions: 3"),
              HasSubstr("metric 'r': 'e' must have 2 dimensions: the bound is horizontal"));
}

}  // namespace
