// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "messages/yaml/message_writer.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(MissionTime, IsTheFirstTimeInsideAZoneOrNearAPlace) {
  MetricWorld world(
      "  - {name: zone, type: mission_time, when: r1 inside goal}\n"
      "  - {name: place, type: mission_time, vehicle: r1, position_m: [2, 2, 0], radius_m: 0.25}\n"
      "  - {name: never, type: mission_time, vehicle: r1, position_m: [9, 9, 0], radius_m: 1}\n"
      "  - {name: talk, type: mission_time, when: message on hello}\n");
  world.drive(0.5);
  double zone_s = -1, place_s = -1;
  for (int i = 0; i < 500; ++i) {
    world.run_for(0.01);
    const double x_m = world.position_m().x();
    const double now_s = sim::to_seconds(world.test.world.now());
    if (zone_s < 0 && x_m >= 2.5) zone_s = now_s;
    if (place_s < 0 && x_m >= 1.75) place_s = now_s;
  }
  world.test.send("hello", shoal::twist_command_t{});
  world.run_for(0.001);
  EXPECT_NEAR(world.figure("zone.time_s"), zone_s, 0.01);  // of the look every 0.01 s
  EXPECT_NEAR(world.figure("place.time_s"), place_s, 0.01);
  EXPECT_TRUE(std::isnan(world.figure("never.time_s")));
  EXPECT_DOUBLE_EQ(world.figure("talk.time_s"), 5.001);
}

}  // namespace
