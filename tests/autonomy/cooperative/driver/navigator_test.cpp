// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/navigator.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "autonomy/cooperative/driver/team_navigator.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;
using test::nav_second;
using test::nav_setup;
using test::received_from;

NavEvent moved_at(Time time, const Vector2& v_W) {
  NavEvent event;
  event.time = time;
  event.v_W = v_W;
  event.q = 0.01 * Matrix2::Identity();
  return event;
}

NavEvent heard_at(Time time, double range_m) {
  static const Bytes payload = test::started("naive", nav_setup(2, 1, {-300, 0}, 1))->make_payload(0, 100);
  NavEvent event;
  event.kind = NavEvent::Kind::received;
  event.time = time;
  event.received = received_from(1, {}, range_m, 1, time);
  event.payload = payload;
  return event;
}

/// Motions of a minute, and a sound each 10 s that is complete `late` motions later.
Estimate estimate_with_delay(int late) {
  Navigator navigator(algorithm_named("naive"), nav_setup(2, 0, {0, 0}, 2));
  std::vector<NavEvent> waiting;
  for (int i = 1; i <= 300; ++i) {
    const Time now = i * nav_second / 5;
    navigator.add(moved_at(now, {1, 0.01 * i}));
    if (i % 50 == 0) waiting.push_back(heard_at(now - nav_second / 20, 300 + 0.2 * i));
    while (!waiting.empty() && waiting.front().time + late * nav_second / 5 <= now) {
      EXPECT_TRUE(navigator.add(waiting.front()));
      waiting.erase(waiting.begin());
    }
  }
  for (const NavEvent& event : waiting) navigator.add(event);
  return navigator.now(61 * nav_second);
}

TEST(Navigator, ASoundCountsAtItsArrivalHoweverLongThePacketIs) {
  const Estimate at_once = estimate_with_delay(1);
  for (const int late : {5, 20, 49}) {
    const Estimate estimate = estimate_with_delay(late);
    EXPECT_EQ(estimate.p_W, at_once.p_W) << late;
    EXPECT_EQ(estimate.P, at_once.P) << late;
  }
}

TEST(Navigator, TheEstimatorIsMovedToTheSoundByTheMotionThatFollows) {
  Navigator navigator(algorithm_named("naive"), nav_setup(2, 0, {0, 0}, 1e-3));
  navigator.add(moved_at(nav_second, {1, 0}));
  navigator.add(moved_at(2 * nav_second, {3, 0}));
  // At 1.5 s it was at 2.5 m: a range of 302.5 m fits.
  navigator.add(heard_at(3 * nav_second / 2, 302.5));
  EXPECT_NEAR(navigator.now(2 * nav_second).p_W.x(), 4, 1e-6);
}

TEST(Navigator, EventsFromBeforeItsWindowAreDropped) {
  Navigator navigator(algorithm_named("naive"), nav_setup(2, 0, {0, 0}, 1));
  for (int i = 1; i <= 60; ++i) navigator.add(moved_at(i * nav_second, {1, 0}));
  EXPECT_FALSE(navigator.add(heard_at(10 * nav_second, 310)));
  EXPECT_EQ(navigator.dropped(), 1);
  EXPECT_TRUE(navigator.add(heard_at(50 * nav_second, 350)));
}

TEST(Navigator, SaysWhereItWillBeWhenTheModemTransmits) {
  Navigator navigator(algorithm_named("naive"), nav_setup(2, 0, {0, 0}, 1));
  navigator.add(moved_at(nav_second, {2, 0}));
  const Bytes payload = navigator.make_payload(3 * nav_second / 2, 100);
  PayloadReader reader(payload);
  EXPECT_NEAR(read_position(reader)->p_W.x(), 3, 1e-9);
  // Motions that are reported afterwards, for before that time, come in between.
  navigator.add(moved_at(5 * nav_second / 4, {4, 0}));
  navigator.add(moved_at(2 * nav_second, {4, 0}));
  EXPECT_NEAR(navigator.now(2 * nav_second).p_W.x(), 6, 1e-9);
}

TEST(Navigator, ACopyIsIndependent) {
  Navigator navigator(algorithm_named("naive"), nav_setup(2, 0, {0, 0}, 1));
  navigator.add(moved_at(nav_second, {1, 0}));
  Navigator copy = navigator;
  navigator.add(heard_at(nav_second, 320));
  EXPECT_NEAR(copy.now(nav_second).p_W.x(), 1, 1e-9);
  EXPECT_NE(navigator.now(nav_second).p_W.x(), copy.now(nav_second).p_W.x());
}

TEST(TeamNavigator, CallsInTheOrderOfTimes) {
  const auto run = [](bool in_order) {
    std::vector<std::function<void(TeamNavigator&)>> calls;
    calls.push_back([](TeamNavigator& team) { team.start(0, nav_setup(2, 0, {0, 0}, 1)); });
    calls.push_back([](TeamNavigator& team) { team.start(1, nav_setup(2, 1, {300, 0}, 1)); });
    for (int i = 1; i <= 20; ++i) {
      calls.push_back([i](TeamNavigator& team) { team.add(0, moved_at(i * nav_second, {1, 0})); });
      calls.push_back([i](TeamNavigator& team) { team.add(1, moved_at(i * nav_second, {0, 1})); });
    }
    calls.push_back([](TeamNavigator& team) { team.sent(0, 10 * nav_second + 7000, 10 * nav_second + 7000); });
    calls.push_back([](TeamNavigator& team) {
      NavEvent event = heard_at(10 * nav_second + 200'000, 291);
      event.received.sender = 0;
      event.received.payload_time = 10 * nav_second + 7000;
      team.add(1, event);
    });
    if (!in_order) std::reverse(calls.begin() + 2, calls.end());
    TeamNavigator team(2);
    for (const auto& call : calls) call(team);
    Estimate estimate;
    team.query(1, 20 * nav_second, [&](const Estimate& answer) { estimate = answer; });
    team.run(*algorithm_named("cekf").make_team());
    return estimate;
  };
  const Estimate ordered = run(true);
  EXPECT_EQ(run(false).p_W, ordered.p_W);
  EXPECT_LT(ordered.P(0, 0), 1.2);  // the range was used: without it 1 + 0.2
}

TEST(TeamNavigator, MovesTheVehicleThatIsSeenToTheTimeOfTheSight) {
  TeamNavigator team(2);
  team.start(0, nav_setup(2, 0, {0, 0}, 1e-3));
  team.start(1, nav_setup(2, 1, {100, 0}, 1e-3));
  for (int i = 1; i <= 2; ++i)
    for (int vehicle : {0, 1}) team.add(vehicle, moved_at(10 * i * nav_second, {vehicle == 1 ? 2.0 : 0.0, 0}));
  NavEvent relative;
  relative.kind = NavEvent::Kind::bearing;
  relative.time = 15 * nav_second;
  relative.seen.time = relative.time;
  relative.seen.other = 1;
  relative.seen.range_m = 130;  // 100 + 2 * 15
  relative.seen.range_std_m = relative.seen.bearing_std_rad = 1e-3;
  team.add(0, relative);
  Estimate estimate;
  team.query(1, 20 * nav_second, [&](const Estimate& answer) { estimate = answer; });
  team.run(*algorithm_named("cekf").make_team());
  EXPECT_NEAR(estimate.p_W.x(), 140, 1e-6);
}

}  // namespace
