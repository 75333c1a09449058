// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_craft.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/autonomy/missions/marine/voyage.hpp"

namespace {

using namespace voyage_test;
using autonomy::CoopCraft;
using autonomy::make_circle;
using autonomy::make_follow;

CoopCraft::Params craft_params() {
  CoopCraft::Params params;
  params.name = "boat1";
  params.id = 7;
  params.access.slot.emplace();
  params.access.slot->slots = 2;
  return params;
}

TEST(CoopCraft, ReportsItsPlaceInItsSlotsByItsOwnClock) {
  CoopCraft craft(craft_params(), make_circle({0, 0}, 30, 1.5));
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

TEST(CoopCraft, RemarksOnceThatItNeverReceivedTheVehicleItFollows) {
  CoopCraft craft(craft_params(), make_follow("auv", 0, 30, 1.5));
  std::vector<std::pair<std::int64_t, std::string>> remarks;
  for (std::int64_t t = epoch; t < epoch + 200 * second; t += second) {
    craft.receive(fix_at(t, {3, -4}));
    const auto decision = craft.step();
    if (!decision.remark.empty()) remarks.emplace_back((t - epoch) / second, decision.remark);
  }
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_EQ(remarks.front().first, 60);
  EXPECT_EQ(remarks.front().second, "after 60 s: it has received no message from 'auv', which it was to follow");
}

TEST(CoopCraft, StopsAndSaysNothingWithoutAFix) {
  CoopCraft craft(craft_params(), make_route({{100, 0}}, 1.5, false));
  EXPECT_FALSE(craft.step().helm);
  craft.receive(fix_at(epoch, {0, 0}));
  EXPECT_EQ(craft.step().helm->speed_mps, 1.5);
  shoal::gps_data_t lost = fix_at(epoch + 20 * second, {not_a_number, not_a_number});
  lost.gps_lock = 0;
  craft.receive(lost);
  const auto decision = craft.step();
  EXPECT_EQ(decision.helm->speed_mps, 0);
  EXPECT_FALSE(decision.send || decision.estimate);
}

TEST(CoopCraft, StopsAndSaysNothingWhenItsGpsFallsSilent) {
  CoopCraft craft(craft_params(), make_route({{100, 0}}, 1.5, false));
  craft.receive(fix_at(epoch, {0, 0}));
  for (int i = 0; i <= 6; ++i) EXPECT_EQ(craft.step().helm->speed_mps, 1.5) << i;  // 3 s
  for (int i = 0; i < 3; ++i) {
    const auto decision = craft.step();
    EXPECT_EQ(decision.helm->speed_mps, 0);
    EXPECT_FALSE(decision.send || decision.estimate);
  }
  craft.receive(fix_at(epoch + 5 * second, {0, 0}));
  EXPECT_EQ(craft.step().helm->speed_mps, 1.5);
}

TEST(CoopCraft, PublishesHoweverSeldomItDecides) {
  for (const int period_s : {2, 5}) {
    CoopCraft::Params params = craft_params();
    params.period_s = period_s;
    CoopCraft craft(params, make_route({{1000, 0}}, 1.5, false));
    std::int64_t t = epoch;
    for (int step = 0; step < 5; ++step) {
      for (int i = 0; i < period_s; ++i) craft.receive(fix_at(t += second, {0, 0}));
      EXPECT_TRUE(craft.step().estimate) << period_s;
    }
    while (t < epoch + 100 * second && craft.step().estimate) t += period_s * second;
    EXPECT_FALSE(craft.step().estimate) << "its GPS is silent";
  }
}

TEST(CoopCraft, FollowsWhatItReceives) {
  CoopCraft craft(craft_params(), make_follow("boat1", 0, 0, 2));
  craft.receive(fix_at(epoch, {0, 0}));
  EXPECT_EQ(craft.step().helm->speed_mps, 0);
  craft.receive(packet({500, 0}, epoch, epoch + second));
  EXPECT_EQ(craft.step().helm->speed_mps, 2);
  shoal::acoustic_received_t bad = packet({500, 0}, epoch, epoch + second);
  bad.data[5] ^= 1;
  craft.receive(bad);
  EXPECT_EQ(craft.counts().received, 1);
  EXPECT_EQ(craft.counts().bad_frames, 1);
}

TEST(CoopCraft, FollowsNoOneByARelayedStateAndTakesNoOrders) {
  CoopCraft craft(craft_params(), make_follow("boat1", 0, 0, 2));
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

}  // namespace
