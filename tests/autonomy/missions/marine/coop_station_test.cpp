// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_station.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "autonomy/acomms/state_packet.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::AcousticState;
using autonomy::CoopStation;
using autonomy::Vector2d;
using testing::HasSubstr;
using testing::ThrowsMessage;

using test::second;
constexpr std::int64_t epoch = 1'767'225'600 * second;  // a multiple of 15 s

/// A station that has the second of three turns of 5 s, with orders after 20 and 100 s.
CoopStation::Params station_params() {
  CoopStation::Params params;
  params.name = "station";
  params.to_id = 7;
  params.orders = {{20, {500, -200}, 15, 1.5}, {100, {0, 300}, 20, 1.2}};
  params.access.slot.emplace();
  params.access.slot->slot = 1;
  params.access.slot->slots = 3;
  params.access.slot->slot_s = 5;
  params.access.slot->guard_s = 2.5;
  return params;
}

shoal::modem_received_t by_radio(const AcousticState& state, std::int64_t utime) {
  const shoal::modem_send_t sent = *autonomy::to_everybody(state);
  shoal::modem_received_t packet{};
  packet.utime = utime;
  packet.sent_utime = utime - second / 10;
  packet.source = "boat";
  packet.size = sent.size;
  packet.data = sent.data;
  return packet;
}

AcousticState state_of(int sender, std::int64_t utime, int order = 0) {
  AcousticState state;
  state.sender = sender;
  state.utime = utime;
  state.east_m = 120;
  state.north_m = -30;
  state.depth_m = 14;
  state.east_std_m = 2;
  state.north_std_m = 3;
  state.correlation = 0.5;
  state.speed_mps = 1.5;
  state.order = order;
  return state;
}

struct Sent {
  std::int64_t at_s;
  autonomy::AcousticOrder order;
};

/// Runs from `from_s` to `to_s` after the epoch, and collects what it sends.
std::vector<Sent> run(CoopStation& station, int from_s, int to_s) {
  std::vector<Sent> sent;
  for (std::int64_t t = epoch + from_s * second; t < epoch + to_s * second; t += second / 2) {
    shoal::gps_data_t fix{};
    fix.utime = t;
    station.receive(fix);
    const auto decision = station.step();
    if (!decision.send) continue;
    EXPECT_EQ(decision.send->destination, "");
    EXPECT_LE(decision.send->size, 32);
    const auto order = autonomy::acoustic_frame::decode_order(decision.send->data, t);
    EXPECT_TRUE(order);
    if (order) sent.push_back({(t - epoch) / second, *order});
  }
  return sent;
}

TEST(CoopStation, SaysAnOrderInEachOfItsTurnsUntilItWasObeyed) {
  CoopStation station(station_params());
  const std::vector<Sent> sent = run(station, 0, 66);
  ASSERT_EQ(sent.size(), 4u);  // turns begin at 5, 20, 35, ...; the order is due after 20 s
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(sent[i].at_s, 20 + 15 * static_cast<int>(i));
    EXPECT_EQ(sent[i].order.number, 1);
    EXPECT_EQ(sent[i].order.receiver, 7);
    EXPECT_EQ(sent[i].order.utime, epoch + sent[i].at_s * second);  // so that no two frames are the same
    EXPECT_EQ(sent[i].order.east_m, 500);
    EXPECT_EQ(sent[i].order.north_m, -200);
    EXPECT_EQ(sent[i].order.depth_m, 15);
    EXPECT_EQ(sent[i].order.speed_mps, 1.5);
  }
  station.receive(by_radio(state_of(7, epoch + 60 * second, 1), epoch + 66 * second));
  EXPECT_TRUE(run(station, 66, 100).empty());
  EXPECT_EQ(station.counts().executed, 1);

  const std::vector<Sent> second_order = run(station, 100, 112);
  ASSERT_EQ(second_order.size(), 1u);
  EXPECT_EQ(second_order[0].order.number, 2);
  EXPECT_EQ(second_order[0].order.speed_mps, 1.2);
}

TEST(CoopStation, LaterOrderTakesThePlaceOfOneThatWasNotObeyed) {
  CoopStation station(station_params());
  run(station, 0, 100);
  for (const Sent& sent : run(station, 100, 200)) EXPECT_EQ(sent.order.number, 2);
  station.receive(by_radio(state_of(7, epoch + 195 * second, 2), epoch + 200 * second));
  EXPECT_TRUE(run(station, 200, 260).empty());
}

TEST(CoopStation, ReportsOnceThatAnOrderWasRefusedAndSaysItNoMore) {
  CoopStation station(station_params());
  run(station, 0, 30);
  AcousticState state = state_of(7, epoch + 29 * second);
  state.refused_order = 1;
  state.refusal = autonomy::OrderRefusal::too_deep;
  station.receive(by_radio(state, epoch + 30 * second));
  EXPECT_EQ(station.step().status, "order 1 was refused: too deep, 15 m");
  EXPECT_EQ(station.counts().refused, 1);
  EXPECT_EQ(station.counts().executed, 0);
  EXPECT_TRUE(run(station, 31, 100).empty());
  state.utime = epoch + 44 * second;  // its next state says so, too
  station.receive(by_radio(state, epoch + 100 * second));
  EXPECT_EQ(station.step().status, "");
  EXPECT_EQ(station.counts().refused, 1);

  EXPECT_EQ(run(station, 100, 112).size(), 1u);  // the second order
  station.receive(by_radio(state_of(7, epoch + 112 * second, 2), epoch + 115 * second));
  EXPECT_EQ(station.step().status, "");
  EXPECT_EQ(station.counts().executed, 1) << "of two, for the first was refused";
}

TEST(CoopStation, StateOfAnotherVehicleObeysNothing) {
  CoopStation station(station_params());
  run(station, 0, 30);
  station.receive(by_radio(state_of(8, epoch + 29 * second, 1), epoch + 30 * second));
  EXPECT_FALSE(station.step().knowledge);
  EXPECT_EQ(run(station, 31, 46).size(), 1u);
}

TEST(CoopStation, KnowsWhereTheVehicleWasByItsOwnTime) {
  CoopStation station(station_params());
  run(station, 0, 10);
  station.receive(by_radio(state_of(7, epoch + 4 * second), epoch + 10 * second));
  const auto knowledge = station.step().knowledge;
  ASSERT_TRUE(knowledge);
  EXPECT_EQ(knowledge->utime, epoch + 4 * second);
  EXPECT_DOUBLE_EQ(knowledge->position_m[0], 120);
  EXPECT_DOUBLE_EQ(knowledge->position_m[1], -30);
  EXPECT_DOUBLE_EQ(knowledge->position_m[2], -14);
  EXPECT_DOUBLE_EQ(knowledge->covariance_m2[0], 4);
  EXPECT_DOUBLE_EQ(knowledge->covariance_m2[4], 9);
  EXPECT_NEAR(knowledge->covariance_m2[1], 3, 3.0 / 127);  // 0.5 * 2 * 3, in steps of the correlation
  EXPECT_EQ(knowledge->covariance_m2[1], knowledge->covariance_m2[3]);
  EXPECT_FALSE(station.step().knowledge);  // once for each state
  // An older one that was late says nothing new.
  station.receive(by_radio(state_of(7, epoch + 3 * second), epoch + 11 * second));
  EXPECT_FALSE(station.step().knowledge);
}

TEST(CoopStation, CovarianceOfAStateIsPositiveDefinite) {
  CoopStation station(station_params());
  AcousticState state = state_of(7, epoch);
  state.correlation = -1;
  station.receive(by_radio(state, epoch + second));
  const auto knowledge = station.step().knowledge;
  ASSERT_TRUE(knowledge);
  const double* P = knowledge->covariance_m2;
  EXPECT_GT(P[0] * P[4] - P[1] * P[3], 0);
}

TEST(CoopStation, DamagedAndStaleStatesAreCountedAndForgotten) {
  CoopStation station(station_params());
  run(station, 0, 30);
  shoal::modem_received_t bad = by_radio(state_of(7, epoch + 29 * second, 1), epoch + 30 * second);
  bad.data[3] ^= 4;
  station.receive(bad);
  station.receive(by_radio(state_of(7, epoch - 60 * second, 1), epoch + 30 * second));
  EXPECT_EQ(station.counts().bad_frames, 2);
  EXPECT_FALSE(station.step().knowledge);
  EXPECT_EQ(station.counts().executed, 0);
}

TEST(CoopStation, SaysNothingBeforeItKnowsTheTime) {
  CoopStation station(station_params());
  EXPECT_FALSE(station.step().send);
}

TEST(CoopStation, OrdersThatCannotBeSaidAreRefused) {
  const auto with = [](const std::vector<CoopStation::TimedOrder>& orders) {
    CoopStation::Params params = station_params();
    params.orders = orders;
    return [params] { CoopStation station(params); };
  };
  EXPECT_NO_THROW(with({{0, {1, 1}, 1, 1.5}, {0, {2, 2}, 2, 1.5}})());
  EXPECT_THAT(with({{10, {1, 1}, 1, 1.5}, {5, {2, 2}, 2, 1.5}}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("must not decrease")));
  EXPECT_THAT(with({{-1, {1, 1}, 1, 1.5}}), ThrowsMessage<std::invalid_argument>(HasSubstr("must be >= 0")));
  EXPECT_THAT(with({{1, {1, 1}, -3, 1.5}}), ThrowsMessage<std::invalid_argument>(HasSubstr("order 1 does not fit")));
  EXPECT_THAT(with({{1, {1, 1}, 3, 1.5}, {2, {1, 1}, 3, 0}}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("order 2 does not fit")));
  EXPECT_THAT(with(std::vector<CoopStation::TimedOrder>(256, {1, {0, 0}, 0, 1.5})),
              ThrowsMessage<std::invalid_argument>(HasSubstr("up to 255 orders")));
}

}  // namespace
