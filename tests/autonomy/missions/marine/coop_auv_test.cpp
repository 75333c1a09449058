// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_auv.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/autonomy/missions/marine/voyage.hpp"

namespace {

using namespace voyage_test;

TEST(CoopAuv, WaitsForAFixAndDives) {
  Voyage voyage(auv_params());
  voyage.run(5);
  EXPECT_EQ(voyage.auv.phase(), CoopAuv::Phase::at_surface);
  EXPECT_EQ(voyage.decision.helm->speed_mps, 0);
  EXPECT_EQ(voyage.decision.helm->depth_m, 0);
  voyage.run(10);
  EXPECT_EQ(voyage.auv.phase(), CoopAuv::Phase::under_way);
  EXPECT_EQ(voyage.decision.helm->speed_mps, 1.5);
  EXPECT_EQ(voyage.decision.helm->depth_m, 20);
}

TEST(CoopAuv, RangesBoundTheErrorThatDeadReckoningLetsGrow) {
  Voyage voyage(auv_params());
  voyage.run(800);
  // 0.07 rad of the way, which began after 11 s.
  EXPECT_NEAR(voyage.reckoned_error_m(), 0.07 * voyage.p_W.x(), 5);
  EXPECT_LT(voyage.error_m(), 4);
  EXPECT_EQ(voyage.auv.counts().ranges + voyage.auv.counts().refused, voyage.auv.counts().frames);
  EXPECT_GE(voyage.auv.counts().ranges, 75);
  EXPECT_NEAR(voyage.auv.cooperative()->heading_bias_rad(), -0.07, 0.02);
}

TEST(CoopAuv, EstimateSaysHowSureItIs) {
  Voyage voyage(auv_params());
  voyage.run(400);
  const shoal::estimate_t& estimate = *voyage.decision.estimate;
  EXPECT_EQ(estimate.utime, voyage.t);
  EXPECT_NEAR(estimate.position_m[2], -20, 1e-9);
  EXPECT_NEAR(estimate.velocity_mps[0], 1.5, 0.05);
  EXPECT_TRUE(std::isnan(estimate.clock_error_s));
  EXPECT_DOUBLE_EQ(estimate.covariance_m2[1], estimate.covariance_m2[3]);
  EXPECT_LT(estimate.covariance_m2[4], 10);
  EXPECT_GT(voyage.decision.dead_reckoning->covariance_m2[4], 1000);  // (0.07 * 580 m)^2
}

TEST(CoopAuv, WithoutCooperationBothEstimatesAreOne) {
  CoopAuv::Params params = auv_params();
  params.use_ranges = false;
  Voyage voyage(params);
  voyage.run(300);
  EXPECT_GT(voyage.auv.counts().frames, 20);
  EXPECT_EQ(voyage.auv.counts().ranges, 0);
  EXPECT_EQ(voyage.auv.cooperative()->position(), voyage.auv.dead_reckoning()->position());
}

TEST(CoopAuv, FindsTheErrorOfItsClock) {
  CoopAuv::Params params = auv_params();
  params.filter.states = 6;
  Voyage voyage(params);
  voyage.clock_error_us = 12'000;  // 18 m
  voyage.run(800);
  EXPECT_LT(voyage.error_m(), 4);
  EXPECT_NEAR(voyage.decision.estimate->clock_error_s, 0.012, 0.002);
}

TEST(CoopAuv, ClockThatIsSetMovesItNowhere) {
  CoopAuv::Params params = auv_params();
  params.filter.states = 6;
  Voyage voyage(params);
  voyage.run(600);
  voyage.waiting.clear();
  for (const std::int64_t error : {100 * second, -50 * second, std::int64_t{0}}) {
    voyage.clock_error_us = error;
    voyage.waiting.clear();
    voyage.run(100);
    EXPECT_LT(voyage.error_m(), 5) << error;
  }
  EXPECT_EQ(voyage.auv.counts().clock_steps, 3);
}

TEST(CoopAuv, SilenceOfAllDevicesIsNoClockThatWasSet) {
  for (const double went_on : {1.0, 0.0}) {
    Voyage voyage(auv_params());
    voyage.run(200);
    const double std_before_m = std::sqrt(voyage.decision.dead_reckoning->covariance_m2[0]);
    voyage.t += 6 * second;  // a power fault
    voyage.p_W.x() += went_on * 9;
    voyage.waiting.clear();
    for (int i = 0; i < 12; ++i) voyage.decision = voyage.auv.step();
    voyage.run(1);
    EXPECT_EQ(voyage.auv.counts().clock_steps, 0);
    EXPECT_EQ(voyage.auv.counts().silences, 1);
    // Along its way; the error of the heading is across.
    const double now_m = voyage.auv.dead_reckoning()->position_at(voyage.t).x();
    EXPECT_NEAR(now_m - voyage.p_W.x(), 9 - 9 * went_on, 1.5);
    const double std_m = std::sqrt(voyage.decision.dead_reckoning->covariance_m2[0]);
    EXPECT_GT(std_m, std::hypot(std_before_m, 9) - 0.1);
    voyage.run(100);
    EXPECT_LT(voyage.error_m(), 4);
  }
}

TEST(CoopAuv, ClockThatIsSetInASilenceIsBoth) {
  Voyage voyage(auv_params());
  voyage.run(200);
  voyage.t += 10 * second;
  voyage.p_W.x() += 15;
  voyage.clock_error_us = -3600 * second;
  voyage.waiting.clear();
  for (int i = 0; i < 20; ++i) voyage.decision = voyage.auv.step();
  voyage.run(1);
  EXPECT_EQ(voyage.auv.counts().clock_steps, 1);
  EXPECT_EQ(voyage.auv.counts().silences, 1);
  EXPECT_LT((voyage.auv.dead_reckoning()->position_at(voyage.t + voyage.clock_error_us) - voyage.p_W).norm(),
            0.07 * voyage.p_W.x() + 3);
}

TEST(CoopAuv, KnownStartNeedsNoFix) {
  CoopAuv::Params params = auv_params();
  params.start_W = Vector2d(10, 20);
  CoopAuv auv(params, make_route({{100, 20}}, 1.5, false));
  auv.receive(compass_at(epoch, 0));
  auv.receive(dvl_at(epoch, 0));
  const auto decision = auv.step();
  EXPECT_EQ(decision.helm->depth_m, 20);
  EXPECT_DOUBLE_EQ(decision.estimate->position_m[0], 10);
  EXPECT_DOUBLE_EQ(decision.estimate->position_m[1], 20);
}

TEST(CoopAuv, ComesUpWhenItsRouteIsDone) {
  CoopAuv::Params params = auv_params();
  params.start_W = Vector2d(0, 0);
  CoopAuv auv(params, make_route({{2, 0}}, 1.5, false));
  auv.receive(compass_at(epoch, 0));
  auv.receive(dvl_at(epoch, 0));
  auv.step();
  EXPECT_EQ(auv.phase(), CoopAuv::Phase::under_way);
  const auto decision = auv.step();
  EXPECT_EQ(auv.phase(), CoopAuv::Phase::done);
  EXPECT_EQ(decision.helm->speed_mps, 0);
  EXPECT_EQ(decision.helm->depth_m, 0);
}

TEST(CoopAuv, CoastsWhenTheDvlIsLostAndIsLessSure) {
  Voyage voyage(auv_params());
  voyage.run(30);
  const double before_m2 = voyage.decision.dead_reckoning->covariance_m2[0];
  for (int i = 1; i <= 50; ++i) {
    voyage.auv.receive(depth_at(voyage.t + i * second / 5, 20));
    voyage.decision = voyage.auv.step();
  }
  EXPECT_NEAR(voyage.decision.dead_reckoning->position_m[0] - voyage.p_W.x(), 15, 1);
  EXPECT_GT(voyage.decision.dead_reckoning->covariance_m2[0], before_m2 + 0.25 * 8);  // 0.5 m in each second
}

TEST(CoopAuv, NonsenseDoesNoHarm) {
  Voyage voyage(auv_params());
  voyage.run(100);
  sim::Random random(3, "nonsense");
  for (int i = 0; i < 500; ++i) {
    random.begin_step(i);
    shoal::acoustic_received_t bad = packet({100 * random.gaussian(), 0}, voyage.t, voyage.t + second / 10);
    bad.data[random.integer_below(28)] ^= static_cast<std::uint8_t>(1u << random.integer_below(8));
    bad.data.resize(random.integer_below(40));
    voyage.auv.receive(bad);
    bad = packet({0, 0}, voyage.t, voyage.t);
    bad.travel_time_s = not_a_number;
    voyage.auv.receive(bad);
    bad = packet({0, 0}, voyage.t, voyage.t);
    bad.sent_utime += 3600 * second;  // the frame says another time
    voyage.auv.receive(bad);
    shoal::dvl_t dvl = dvl_at(voyage.t, not_a_number);
    voyage.auv.receive(dvl);
    shoal::ins_t attitude{};
    attitude.utime = voyage.t;
    voyage.auv.receive(attitude);  // a quaternion of zeros
    voyage.auv.receive(fix_at(voyage.t, {not_a_number, 0}));
    voyage.auv.receive(depth_at(voyage.t, not_a_number));
    voyage.auv.receive(compass_at(voyage.t, not_a_number));
  }
  EXPECT_EQ(voyage.auv.counts().bad_frames, 1000);
  EXPECT_LT(voyage.error_m(), 3);
}

/// An order as it comes from whoever passes it on.
shoal::acoustic_received_t order_packet(int number, const Vector2d& p_W, double depth_m, std::int64_t sent,
                                        int receiver = 100) {
  const shoal::modem_send_t message =
      *autonomy::to_everybody(autonomy::AcousticOrder{200, receiver, number, sent, p_W.x(), p_W.y(), depth_m, 1.2});
  shoal::acoustic_received_t received{};
  received.sent_utime = sent + second;
  received.utime = sent + 3 * second;
  received.travel_time_s = 2;
  received.source = "boat1";
  received.size = message.size;
  received.data = message.data;
  return received;
}

CoopAuv::Params obeying_params() {
  CoopAuv::Params params = auv_params();
  params.execute = true;
  params.access.slot.emplace();
  return params;
}

TEST(CoopAuv, ObeysAnOrderAndSaysSoInItsState) {
  Voyage voyage(obeying_params());
  voyage.run(30);
  const int ranges = voyage.auv.counts().ranges + voyage.auv.counts().refused;
  voyage.auv.receive(order_packet(3, {0, 1000}, 35, voyage.t));
  EXPECT_EQ(voyage.auv.counts().ranges + voyage.auv.counts().refused, ranges);  // an order is not a range
  const auto decision = voyage.auv.step();
  EXPECT_EQ(decision.helm->speed_mps, 1.2);
  EXPECT_NEAR(decision.helm->heading_rad, 0.5 * pi, 0.1);  // it is some 30 m east of its start
  EXPECT_EQ(decision.helm->depth_m, 35);
  const auto state = [&] {
    for (int i = 0; i < 100; ++i) {
      voyage.t += second / 5;
      voyage.auv.receive(depth_at(voyage.t, 20));
      if (const auto sent = voyage.auv.step().send) return autonomy::acoustic_frame::decode(sent->data, voyage.t);
    }
    return std::optional<AcousticState>();
  }();
  ASSERT_TRUE(state);
  EXPECT_EQ(state->order, 3);
}

TEST(CoopAuv, ObeysOnlyNewOrdersThatAreForItAndCanBeDone) {
  const auto executed = [](auto change, const CoopAuv::Params& params = obeying_params()) {
    CoopAuv auv(params, make_route({{100, 0}}, 1.5, false));
    auv.receive(order_packet(2, {0, 100}, 10, epoch));
    auv.receive(change(order_packet(3, {0, 100}, 10, epoch + second)));
    return auv.counts().orders;
  };
  const auto as_it_is = [](const shoal::acoustic_received_t& packet) { return packet; };
  EXPECT_EQ(executed(as_it_is), 2);
  EXPECT_EQ(executed(as_it_is, auv_params()), 0);  // without --execute
  EXPECT_EQ(executed([](const auto&) { return order_packet(2, {0, 200}, 10, epoch + second); }), 1);
  EXPECT_EQ(executed([](const auto&) { return order_packet(1, {0, 200}, 10, epoch + second); }), 1);
  EXPECT_EQ(executed([](const auto&) { return order_packet(3, {0, 200}, 10, epoch + second, 99); }), 1);
  EXPECT_EQ(executed([](const auto&) { return order_packet(3, {0, 200}, 100.1, epoch + second); }), 1);
  EXPECT_EQ(executed([](auto packet) {
              packet.sent_utime += 61 * second;  // an old order that someone says again
              return packet;
            }),
            1);
  EXPECT_EQ(executed([](auto packet) {
              packet.data[9] ^= 1;
              return packet;
            }),
            1);
}

TEST(CoopAuv, SaysInItsStateThatItRefusedAnOrderUntilItObeysALaterOne) {
  Voyage voyage(obeying_params());
  voyage.run(30);
  const auto state = [&] {
    for (int i = 0; i < 100; ++i) {
      voyage.t += second / 5;
      voyage.auv.receive(depth_at(voyage.t, 20));
      if (const auto sent = voyage.auv.step().send) return *autonomy::acoustic_frame::decode(sent->data, voyage.t);
    }
    ADD_FAILURE() << "it says nothing";
    return AcousticState();
  };
  voyage.auv.receive(order_packet(1, {0, 1000}, 35, voyage.t));
  EXPECT_EQ(state().refused_order, 0);
  for (int i = 0; i < 2; ++i) voyage.auv.receive(order_packet(2, {0, 1000}, 100.1, voyage.t));
  EXPECT_EQ(voyage.auv.counts().orders_refused, 1);
  EXPECT_EQ(state().order, 1);
  EXPECT_EQ(state().refused_order, 2);
  EXPECT_EQ(state().refusal, autonomy::OrderRefusal::too_deep);
  EXPECT_EQ(voyage.auv.step().helm->depth_m, 35) << "it continues with the previous order";
  voyage.auv.receive(order_packet(3, {0, 900}, 30, voyage.t));
  const AcousticState obeying = state();
  EXPECT_EQ(obeying.order, 3);
  EXPECT_EQ(obeying.refused_order, 0);
  EXPECT_EQ(obeying.refusal, autonomy::OrderRefusal::none);
}

TEST(CoopAuv, OrderFetchesItBackFromTheEndOfItsRoute) {
  CoopAuv::Params params = obeying_params();
  params.start_W = Vector2d(0, 0);
  CoopAuv auv(params, make_route({{2, 0}}, 1.5, false));
  auv.receive(compass_at(epoch, 0));
  auv.receive(dvl_at(epoch, 0));
  auv.step();
  auv.step();
  ASSERT_EQ(auv.phase(), CoopAuv::Phase::done);
  auv.receive(order_packet(1, {100, 0}, 15, epoch));
  EXPECT_EQ(auv.step().helm->depth_m, 15);
  EXPECT_EQ(auv.phase(), CoopAuv::Phase::under_way);
}

TEST(CoopAuv, StateThatCameByRelayIsNoRange) {
  const auto ranges = [](auto change) {
    Voyage voyage(auv_params());
    voyage.run(60);
    const int before = voyage.auv.counts().ranges + voyage.auv.counts().refused;
    const int relayed = voyage.auv.counts().relayed;
    shoal::acoustic_received_t relay = packet(voyage.beacons[0], voyage.t - second, voyage.t);
    change(relay, voyage.t);
    voyage.auv.receive(relay);
    const int used = voyage.auv.counts().ranges + voyage.auv.counts().refused - before;
    EXPECT_EQ(used + voyage.auv.counts().relayed - relayed, 1);
    return used;
  };
  EXPECT_EQ(ranges([](auto&, std::int64_t) {}), 1);
  // Said again by another vehicle, at once and late, and late by its own sender; and its own state, which came back.
  EXPECT_EQ(ranges([](auto& relay, std::int64_t) { relay.source = "boat2"; }), 0);
  EXPECT_EQ(ranges([](auto& relay, std::int64_t) { relay.sent_utime += 4 * second; }), 0);
  EXPECT_EQ(ranges([](auto& relay, std::int64_t t) {
              AcousticState own;
              own.sender = 100;
              own.utime = t - second;
              own.east_std_m = own.north_std_m = 1;
              relay.data = autonomy::to_everybody(own)->data;
            }),
            0);
}

TEST(CoopAuv, ReportsItsStateInItsSlotWithItsCovariance) {
  CoopAuv::Params params = auv_params();
  params.access.slot.emplace();
  Voyage voyage(params);
  voyage.run(99);
  EXPECT_EQ(voyage.auv.counts().sent, 10);  // one each 10 s
}

}  // namespace
