// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bridges/view/view_publisher.hpp"
#include "shoal/message_schema.hpp"
#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace viewed_world {

using Json = nlohmann::json;

/// A world whose view is published, with everything that it publishes.
struct ViewedWorld {
  explicit ViewedWorld(const std::string& yaml) : test(yaml) { view.after_step(); }
  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      view.after_step();
    }
  }
  Json last_scene() { return Json::parse(scenes.last().scene); }

  test::TestWorld test;
  test::Listener<shoal::sim_scene_t> scenes{test, "sim.scene"};
  test::Listener<shoal::sim_asset_t> assets{test, "sim.asset"};
  test::Listener<shoal::sim_bodies_t> bodies{test, "sim.bodies"};
  test::Listener<shoal::sim_sound_t> sounds{test, "sim.sound"};
  test::Listener<shoal::sim_sound_arrival_t> arrivals{test, "sim.sound.arrival"};
  test::Listener<shoal::sim_event_t> events{test, "sim.event"};
  test::Listener<shoal::sim_current_t> currents{test, "sim.current"};
  bridges::ViewPublisher view{test.bus, test.world, {}, [] { return true; }};
};

/// A rover on the ground, and a ball that falls beside it.
inline const std::string rover_and_ball =
    test::rover_world("        - {name: lidar, type: lidar, body: chassis, fov_deg: 90, beams: 3, range_max_m: 8}\n",
                      "  - {name: ball, position_m: [3, 0, 1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n");

}  // namespace viewed_world
