// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_record.hpp"

#include <gtest/gtest.h>

namespace {

using namespace navigation;

/// Record with the truth of three robots, each second for 10 s.
NavRecord recorded(const std::string& metrics) {
  auto team = std::make_shared<NavTeam>();
  for (const char* name : {"robot1", "robot2", "robot3"}) team->vehicles.emplace_back().name = name;
  NavRecord record;
  record.team = team;
  begin_truth(record, "shoal: 1\nname: room\n" + metrics);
  for (int t = 0; t <= 10; ++t) {
    shoal::sim_state_t state{};
    state.utime = 1'000'000 * t;
    state.vehicle = {"ball", "robot1", "robot2", "robot3"};
    state.position_m = {{9, 9, 9}, {1.0 * t, 0, 0}, {2.0 * t, 0, 0}, {3.0 * t, 0, 0}};
    add_truth(record, state);
  }
  return record;
}

TEST(NavRecord, TruthEndsWithTheScoringOfTheVehicle) {
  const NavRecord record = recorded(
      "metrics:\n"
      "  - {name: a, type: position_error, vehicle: robot1, channel: robot1.estimate, until_s: 3}\n"
      "  - {name: b, type: consistency, vehicle: robot1, channel: robot1.estimate, until_s: 4}\n"
      "  - {name: c, type: position_error, vehicle: robot2, channel: robot2.estimate, until_s: 5}\n"
      "  - {name: d, type: position_error, vehicle: robot2, channel: robot2.raw}\n"
      "  - {name: e, type: trajectory, vehicle: robot3, channel: robot3.slam, until_s: 2}\n");
  // The latest end counts; one without an end, or of another kind, does not limit.
  EXPECT_EQ(record.truth[0].size(), 5U);
  EXPECT_EQ(record.truth[1].size(), 11U);
  EXPECT_EQ(record.truth[2].size(), 11U);
  EXPECT_EQ(true_position(record.truth[0], 3'500'000)->x(), 3.5);
  EXPECT_FALSE(true_position(record.truth[0], 4'500'000));
}

TEST(NavRecord, TruthOfAWorldWithoutMetricsIsThatOfTheRun) {
  EXPECT_EQ(recorded("").truth[0].size(), 11U);
}

}  // namespace
