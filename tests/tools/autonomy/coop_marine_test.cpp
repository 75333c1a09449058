#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/random/random.hpp"
#include "tools/autonomy/behaviour_text.hpp"
#include "tools/autonomy/coop_auv.hpp"
#include "tools/autonomy/coop_craft.hpp"
#include "tools/autonomy/state_packet.hpp"

namespace {

using autonomy::AcousticState;
using autonomy::CoopAuv;
using autonomy::CoopCraft;
using autonomy::make_behaviour;
using autonomy::Vector2d;

constexpr std::int64_t second = 1'000'000;
constexpr std::int64_t epoch = 1'767'225'600 * second;  // a multiple of 20 s
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = std::numbers::pi;

shoal::gps_data_t fix_at(std::int64_t utime, const Vector2d& p_W, double std_m = 0.5) {
  shoal::gps_data_t fix{};
  fix.utime = utime;
  fix.gps_lock = 1;
  fix.horizontal_accuracy = std_m;
  fix.xyz_pos[0] = p_W.x();
  fix.xyz_pos[1] = p_W.y();
  return fix;
}

shoal::dvl_t dvl_at(std::int64_t utime, double ahead_mps) {
  shoal::dvl_t dvl{};
  dvl.utime = utime;
  dvl.bottom_lock = 1;
  dvl.velocity_mps[0] = ahead_mps;
  return dvl;
}

shoal::compass_t compass_at(std::int64_t utime, double yaw_rad) {
  shoal::compass_t compass{};
  compass.utime = utime;
  compass.heading_true_rad = 0.5 * pi - yaw_rad;
  return compass;
}

shoal::pressure_t depth_at(std::int64_t utime, double depth_m) {
  shoal::pressure_t pressure{};
  pressure.utime = utime;
  pressure.depth_m = depth_m;
  return pressure;
}

/// A frame from a beacon at rest.
shoal::acoustic_received_t packet(const Vector2d& beacon_W, std::int64_t sent, std::int64_t arrival, int sender = 1) {
  AcousticState state;
  state.sender = sender;
  state.utime = sent - second / 5;
  state.east_m = beacon_W.x();
  state.north_m = beacon_W.y();
  state.depth_m = 1;
  state.east_std_m = state.north_std_m = 0.5;
  const shoal::modem_send_t sent_message = *autonomy::to_everybody(state);
  shoal::acoustic_received_t received{};
  received.utime = arrival;
  received.sent_utime = sent;
  received.travel_time_s = static_cast<double>(arrival - sent) * 1e-6;
  received.source = "boat" + std::to_string(sender);
  received.size = sent_message.size;
  received.data = sent_message.data;
  return received;
}

CoopCraft::Params craft_params() {
  CoopCraft::Params params;
  params.name = "boat1";
  params.id = 7;
  params.access.slot.emplace();
  params.access.slot->slots = 2;
  return params;
}

TEST(CoopCraft, TellsItsPlaceInItsSlotsByItsOwnClock) {
  CoopCraft craft(craft_params(), make_behaviour("circle:0,0,30", {}, 1.5, false));
  std::vector<std::int64_t> sent;
  for (std::int64_t t = epoch; t < epoch + 60 * second; t += second / 2) {
    shoal::gps_data_t fix = fix_at(t, {3, -4});
    fix.speed = 1.5;
    fix.heading = 0.5 * pi;  // east
    craft.receive(fix);
    const auto decision = craft.step();
    ASSERT_TRUE(decision.helm && decision.estimate);
    EXPECT_EQ(decision.estimate->utime, t);
    if (!decision.send) continue;
    sent.push_back((t - epoch) / second);
    EXPECT_EQ(decision.send->destination, "");
    EXPECT_LE(decision.send->size, 32);
    const auto state = autonomy::acoustic_frame::decode(decision.send->data, t);
    ASSERT_TRUE(state);
    EXPECT_EQ(state->sender, 7);
    EXPECT_EQ(state->utime, t);
    EXPECT_NEAR(state->east_m, 3, 0.01);
    EXPECT_NEAR(state->east_std_m, 0.5, 0.011);
    EXPECT_NEAR(autonomy::motion_of(*state).v_W.x(), 1.5, 0.01);
  }
  EXPECT_EQ(sent, (std::vector<std::int64_t>{0, 20, 40}));
  EXPECT_EQ(craft.counts().sent, 3);
}

TEST(CoopCraft, StopsAndSaysNothingWithoutAFix) {
  CoopCraft craft(craft_params(), make_behaviour("route", {{100, 0}}, 1.5, false));
  EXPECT_FALSE(craft.step().helm);
  craft.receive(fix_at(epoch, {0, 0}));
  EXPECT_EQ(craft.step().helm->speed_mps, 1.5);
  shoal::gps_data_t lost = fix_at(epoch + 20 * second, {nan, nan});
  lost.gps_lock = 0;
  craft.receive(lost);
  const auto decision = craft.step();
  EXPECT_EQ(decision.helm->speed_mps, 0);
  EXPECT_FALSE(decision.send || decision.estimate);
}

TEST(CoopCraft, StopsAndSaysNothingWhenItsGpsFallsSilent) {
  CoopCraft craft(craft_params(), make_behaviour("route", {{100, 0}}, 1.5, false));
  craft.receive(fix_at(epoch, {0, 0}));
  for (int i = 1; i <= 6; ++i) EXPECT_EQ(craft.step().helm->speed_mps, 1.5) << i;  // 3 s
  for (int i = 0; i < 3; ++i) {
    const auto decision = craft.step();
    EXPECT_EQ(decision.helm->speed_mps, 0);
    EXPECT_FALSE(decision.send || decision.estimate);
  }
  craft.receive(fix_at(epoch + 5 * second, {0, 0}));
  EXPECT_EQ(craft.step().helm->speed_mps, 1.5);
}

TEST(CoopCraft, FollowsWhatItHears) {
  CoopCraft craft(craft_params(), make_behaviour("follow:boat1,0,0", {}, 2, false));
  craft.receive(fix_at(epoch, {0, 0}));
  EXPECT_EQ(craft.step().helm->speed_mps, 0);
  craft.receive(packet({500, 0}, epoch, epoch + second));
  EXPECT_EQ(craft.step().helm->speed_mps, 2);
  shoal::acoustic_received_t bad = packet({500, 0}, epoch, epoch + second);
  bad.data[5] ^= 1;
  craft.receive(bad);
  EXPECT_EQ(craft.counts().heard, 1);
  EXPECT_EQ(craft.counts().bad_frames, 1);
}

TEST(CoopCraft, FollowsNobodyByARelayedStateAndTakesNoOrders) {
  CoopCraft craft(craft_params(), make_behaviour("follow:boat1,0,0", {}, 2, false));
  craft.receive(fix_at(epoch, {0, 0}));
  craft.receive(packet({500, 0}, epoch, epoch + second));
  shoal::acoustic_received_t relayed = packet({0, 500}, epoch + 10 * second, epoch + 11 * second);
  relayed.sent_utime += 5 * second;
  craft.receive(relayed);
  const shoal::modem_send_t order = *autonomy::to_everybody(autonomy::AcousticOrder{200, 7, 1, epoch, 0, 500, 1, 1});
  relayed.sent_utime = epoch + second;
  relayed.data = order.data;
  craft.receive(relayed);
  EXPECT_EQ(craft.counts().relayed, 1);
  EXPECT_EQ(craft.counts().orders, 1);
  EXPECT_EQ(craft.counts().bad_frames, 0);
  EXPECT_NEAR(craft.step().helm->heading_rad, 0, 1e-9);  // east, where the other said that it was
}

/// An AUV that goes east at 1.5 m/s with a compass that is 4 degrees off, between two beacons that send each 10 s; a
/// packet takes 3 s, and is reported when it is complete.
struct Voyage {
  explicit Voyage(const CoopAuv::Params& params) : auv(params, make_behaviour("route", {{5000, 0}}, 1.5, false)) {}

  void run(int seconds) {
    sim::Random random(1, "voyage");
    for (int i = 1; i <= 5 * seconds; ++i) {
      t += second / 5;
      random.begin_step(i);
      const std::int64_t own = t + clock_error_us;
      const bool submerged = decision.helm && decision.helm->depth_m > 0;
      if (submerged) p_W.x() += 0.3;
      if (has_heading) auv.receive(compass_at(own, 0.07 + 0.02 * random.gaussian()));
      auv.receive(depth_at(own, submerged ? 20 : 0));
      auv.receive(dvl_at(own, submerged ? 1.5 : 0));
      if (!submerged && i % 5 == 0) auv.receive(fix_at(own, p_W));
      if (i % 50 == 0) hear(beacons[static_cast<std::size_t>(i / 50 % 2)], own, random.gaussian());
      while (!waiting.empty() && waiting.front().utime + 3 * second <= own) {
        auv.receive(waiting.front());
        waiting.erase(waiting.begin());
      }
      if (i % 2 == 0) decision = auv.step();
    }
  }
  void hear(const Vector2d& beacon_W, std::int64_t own, double noise_m) {
    const double depth_m = decision.helm && decision.helm->depth_m > 0 ? 19 : -1;
    const double range_m = std::hypot((p_W + modem_W - beacon_W).norm(), depth_m) + noise_m;
    const bool first = beacon_W == beacons[0];
    waiting.push_back(packet(first ? beacon_W + wrong_by_W : beacon_W,
                             own - clock_error_us - std::llround(range_m / 1500 * 1e6), own, first ? 1 : 2));
  }
  double error_m() const { return (auv.cooperative()->position_at(t + clock_error_us) - p_W).norm(); }
  double reckoned_error_m() const { return (auv.dead_reckoning()->position_at(t + clock_error_us) - p_W).norm(); }

  CoopAuv auv;
  CoopAuv::Decision decision;
  std::int64_t t = epoch;
  std::int64_t clock_error_us = 0;
  Vector2d p_W = Vector2d::Zero();
  Vector2d modem_W = Vector2d::Zero();
  Vector2d wrong_by_W = Vector2d::Zero();  ///< what the first beacon says of itself
  bool has_heading = true;
  std::array<Vector2d, 2> beacons = {Vector2d(300, 300), Vector2d(900, -250)};
  std::vector<shoal::acoustic_received_t> waiting;
};

CoopAuv::Params auv_params() {
  CoopAuv::Params params;
  params.name = "auv";
  params.depth_m = 20;
  params.filter.heading_bias_std_rad = 0.07;
  return params;
}

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
  for (const bool told : {false, true}) {
    if (told) params.modem_B = {20, 0, 0};  // a long vehicle, so that it counts
    Voyage voyage(params);
    voyage.modem_W = {20, 0};  // it goes east
    voyage.run(600);
    errors_m[told ? 1 : 0] = voyage.error_m();
  }
  EXPECT_LT(errors_m[1], 4);
  EXPECT_GT(errors_m[0], 10);
}

TEST(CoopAuv, FixesAreThoseOfItsAntenna) {
  CoopAuv::Params params = auv_params();
  params.gps_B = {3, 0, 0};
  CoopAuv auv(params, make_behaviour("route", {{100, 0}}, 1.5, false));
  auv.receive(compass_at(epoch, 0.5 * pi));
  auv.receive(fix_at(epoch, {10, 20}));
  EXPECT_NEAR((auv.cooperative()->position() - Vector2d(10, 17)).norm(), 0, 1e-9);
}

TEST(CoopAuv, SaysNothingOfItsPlaceWhileAllItsDevicesAreSilent) {
  Voyage voyage(auv_params());
  voyage.run(30);
  EXPECT_TRUE(voyage.auv.step().estimate);  // the second since the last report: 1 s
  const auto decision = voyage.auv.step();
  EXPECT_FALSE(decision.estimate || decision.dead_reckoning || decision.send);
  voyage.run(1);
  EXPECT_TRUE(voyage.decision.estimate);
}

TEST(CoopAuv, KnownStartNeedsNoFix) {
  CoopAuv::Params params = auv_params();
  params.start_W = Vector2d(10, 20);
  CoopAuv auv(params, make_behaviour("route", {{100, 20}}, 1.5, false));
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
  CoopAuv auv(params, make_behaviour("route", {{2, 0}}, 1.5, false));
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
    bad.travel_time_s = nan;
    voyage.auv.receive(bad);
    bad = packet({0, 0}, voyage.t, voyage.t);
    bad.sent_utime += 3600 * second;  // the frame says another time
    voyage.auv.receive(bad);
    shoal::dvl_t dvl = dvl_at(voyage.t, nan);
    voyage.auv.receive(dvl);
    shoal::ins_t attitude{};
    attitude.utime = voyage.t;
    voyage.auv.receive(attitude);  // a quaternion of zeros
    voyage.auv.receive(fix_at(voyage.t, {nan, 0}));
    voyage.auv.receive(depth_at(voyage.t, nan));
    voyage.auv.receive(compass_at(voyage.t, nan));
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
  params.obey = true;
  params.access.slot.emplace();
  return params;
}

TEST(CoopAuv, ObeysAnOrderAndSaysSoInItsState) {
  Voyage voyage(obeying_params());
  voyage.run(30);
  const int ranges = voyage.auv.counts().ranges + voyage.auv.counts().refused;
  voyage.auv.receive(order_packet(3, {0, 1000}, 35, voyage.t));
  EXPECT_EQ(voyage.auv.counts().ranges + voyage.auv.counts().refused, ranges);  // an order is no range
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
  const auto obeyed = [](auto change, const CoopAuv::Params& params = obeying_params()) {
    CoopAuv auv(params, make_behaviour("route", {{100, 0}}, 1.5, false));
    auv.receive(order_packet(2, {0, 100}, 10, epoch));
    auv.receive(change(order_packet(3, {0, 100}, 10, epoch + second)));
    return auv.counts().orders;
  };
  const auto as_it_is = [](const shoal::acoustic_received_t& packet) { return packet; };
  EXPECT_EQ(obeyed(as_it_is), 2);
  EXPECT_EQ(obeyed(as_it_is, auv_params()), 0);  // without --obey
  EXPECT_EQ(obeyed([](const auto&) { return order_packet(2, {0, 200}, 10, epoch + second); }), 1);
  EXPECT_EQ(obeyed([](const auto&) { return order_packet(1, {0, 200}, 10, epoch + second); }), 1);
  EXPECT_EQ(obeyed([](const auto&) { return order_packet(3, {0, 200}, 10, epoch + second, 99); }), 1);
  EXPECT_EQ(obeyed([](const auto&) { return order_packet(3, {0, 200}, 100.1, epoch + second); }), 1);
  EXPECT_EQ(obeyed([](auto packet) {
              packet.sent_utime += 61 * second;  // an old order that somebody says again
              return packet;
            }),
            1);
  EXPECT_EQ(obeyed([](auto packet) {
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
  EXPECT_EQ(voyage.auv.step().helm->depth_m, 35) << "it goes on as it was told before";
  voyage.auv.receive(order_packet(3, {0, 900}, 30, voyage.t));
  const AcousticState obeying = state();
  EXPECT_EQ(obeying.order, 3);
  EXPECT_EQ(obeying.refused_order, 0);
  EXPECT_EQ(obeying.refusal, autonomy::OrderRefusal::none);
}

TEST(CoopAuv, OrderFetchesItBackFromTheEndOfItsRoute) {
  CoopAuv::Params params = obeying_params();
  params.start_W = Vector2d(0, 0);
  CoopAuv auv(params, make_behaviour("route", {{2, 0}}, 1.5, false));
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

TEST(CoopAuv, TellsItsStateInItsSlotWithItsCovariance) {
  CoopAuv::Params params = auv_params();
  params.access.slot.emplace();
  Voyage voyage(params);
  voyage.run(99);
  EXPECT_EQ(voyage.auv.counts().sent, 10);  // one each 10 s
}

}  // namespace
