// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/team_navigator.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "autonomy/cooperative/driver/navigator.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"
#include "tests/autonomy/cooperative/driver/navigator_fixture.hpp"

namespace {

using namespace navigator_fixture;
using namespace navigation;

using test::nav_second;
using test::nav_setup;

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
