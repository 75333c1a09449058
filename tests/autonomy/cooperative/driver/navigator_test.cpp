// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/navigator.hpp"

#include <gtest/gtest.h>

#include "autonomy/cooperative/driver/team_navigator.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"
#include "tests/autonomy/cooperative/driver/navigator_fixture.hpp"

namespace {

using namespace navigator_fixture;
using namespace navigation;

using test::nav_second;
using test::nav_setup;

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

}  // namespace
