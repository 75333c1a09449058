// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/missions/marine/coop_auv.hpp"
#include "tests/autonomy/missions/marine/voyage.hpp"

namespace {

using namespace voyage_test;

TEST(CoopAuv, AClockFarFromWhatItWasTakenForDoesNoHarm) {
  for (const std::int64_t error_us : {second / 2, -second, 3600 * second}) {
    CoopAuv::Params params = auv_params();
    params.filter.states = 6;  // and a clock that is taken for 20 ms
    Voyage voyage(params);
    voyage.clock_error_us = error_us;
    voyage.run(800);
    EXPECT_NEAR(voyage.reckoned_error_m(), 0.07 * voyage.p_W.x(), 5);
    if (error_us > 60 * second) {
      // No sound takes an hour: dead reckoning is left.
      EXPECT_EQ(voyage.auv.counts().ranges, 0);
      EXPECT_NEAR(voyage.error_m(), voyage.reckoned_error_m(), 1e-6);
    } else {
      EXPECT_NEAR(voyage.decision.estimate->clock_error_s, 1e-6 * static_cast<double>(error_us), 0.003);
      EXPECT_LT(voyage.error_m(), 6);
    }
  }
}

TEST(CoopAuv, ABeaconThatIsWrongOfItselfDoesNoHarm) {
  CoopAuv::Params params = auv_params();
  params.filter.states = 6;
  Voyage voyage(params);
  voyage.run(300);
  voyage.wrong_by_W = {200, 200};
  voyage.run(500);
  EXPECT_LT(voyage.error_m(), voyage.reckoned_error_m());
  EXPECT_GE(voyage.auv.counts().refused, 20);  // of the first beacon, one each 20 s
  EXPECT_LT(voyage.error_m(), 3 * std::sqrt(voyage.auv.cooperative()->position_covariance().trace()));
}

TEST(CoopAuv, LostHeadingMakesItUnsureAndRangesKeepIt) {
  Voyage voyage(auv_params());
  voyage.run(300);
  voyage.has_heading = false;
  voyage.run(300);
  // 1.5 m/s for a minute in any direction, as noise: 1.5 sqrt(60) m after 1 s.
  const double std_m = std::sqrt(voyage.auv.dead_reckoning()->position_covariance()(0, 0));
  EXPECT_NEAR(std_m, 1.5 * std::sqrt(60.0 * 298), 15);
  EXPECT_LT(voyage.error_m(), 3 * std::sqrt(voyage.auv.cooperative()->position_covariance().trace()));
  voyage.has_heading = true;
  voyage.run(200);
  EXPECT_LT(voyage.error_m(), 8);
}

TEST(CoopAuv, RangesAreThoseOfItsModem) {
  CoopAuv::Params params = auv_params();
  params.range_std_m = 0.1;
  params.sound_speed_std = 0;
  double errors_m[2];
  for (const bool reported : {false, true}) {
    if (reported) params.modem_B = {20, 0, 0};  // a long vehicle, so that it counts
    Voyage voyage(params);
    voyage.modem_W = {20, 0};  // it goes east
    voyage.run(600);
    errors_m[reported ? 1 : 0] = voyage.error_m();
  }
  EXPECT_LT(errors_m[1], 4);
  EXPECT_GT(errors_m[0], 10);
}

TEST(CoopAuv, FixesAreThoseOfItsAntenna) {
  CoopAuv::Params params = auv_params();
  params.gps_B = {3, 0, 0};
  CoopAuv auv(params, make_route({{100, 0}}, 1.5, false));
  auv.receive(compass_at(epoch, 0.5 * pi));
  auv.receive(fix_at(epoch, {10, 20}));
  EXPECT_NEAR((auv.cooperative()->position() - Vector2d(10, 17)).norm(), 0, 1e-9);
}

TEST(CoopAuv, SaysNothingOfItsPlaceWhileAllItsDevicesAreSilent) {
  Voyage voyage(auv_params());
  voyage.run(30);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(voyage.auv.step().estimate);  // 1 s without a report
  const auto decision = voyage.auv.step();
  EXPECT_FALSE(decision.estimate || decision.dead_reckoning || decision.send);
  voyage.run(1);
  EXPECT_TRUE(voyage.decision.estimate);
}

TEST(CoopAuv, PublishesHoweverSeldomItDecides) {
  for (const int period_s : {2, 5}) {
    CoopAuv::Params params = auv_params();
    params.period_s = period_s;
    CoopAuv auv(params, make_route({{1000, 0}}, 1.5, false));
    std::int64_t t = epoch;
    for (int step = 0; step < 20; ++step) {
      for (int i = 0; i < 2 * period_s; ++i) {
        t += second / 2;
        auv.receive(compass_at(t, 0));
        auv.receive(dvl_at(t, 0));
        auv.receive(fix_at(t, {0, 0}));
      }
      EXPECT_TRUE(auv.step().estimate) << period_s;
    }
    EXPECT_FALSE(auv.step().estimate) << period_s << " s of silence";
    EXPECT_EQ(auv.counts().clock_steps, 0) << period_s;
  }
}

}  // namespace
