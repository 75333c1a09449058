// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <cstring>
#include <span>
#include <string>

#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/state_fixture.hpp"

namespace busy_worlds {

/// Boxes that fall onto each other, objects of two bodies, rovers, an actor, events: things that come and go while it
/// runs.
inline const char* const busy_world = R"(
shoal: 1
physics: {step_s: 0.005}
materials: [{name: rubber}]
contacts: [{between: [rubber, any], friction: 0.8}]
run: {seed: 5}
medium: {wind: {speed_mps: 3, gusts: {}}}
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
  - {name: gate, position_m: [6, 0, 0.5], parts: [{shape: box, size_m: [0.2, 2, 1]}]}
  - {name: crate, position_m: [0, 4, 0.3], count: 5, placement: {pattern: line, spacing_m: 0.3},
     parts: [{shape: box, size_m: [0.4, 0.4, 0.4], mass_kg: 2}]}
  - {name: late, present: false, position_m: [2, 3, 1], parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}
  - name: swing
    position_m: [-6, 4, 0]
    bodies:
      - {name: rope, position_m: [0.5, 0, 2], parts: [{shape: box, size_m: [1, 0.1, 0.1], mass_kg: 2}]}
      - {name: seat, position_m: [1.2, 0, 2], parts: [{shape: box, size_m: [0.4, 0.1, 0.1], mass_kg: 1}]}
    joints:
      - {name: top, type: hinge, bodies: [rope, world], anchor_m: [0, 0, 2], axis: [0, 1, 0], damping: 0.1}
      - {name: knee, type: hinge, bodies: [rope, seat], anchor_m: [1, 0, 2], axis: [0, 1, 0], low_stop: -0.5}
  - name: late_swing
    present: false
    position_m: [-6, -4, 0]
    bodies: [{name: rope, position_m: [0.5, 0, 2], parts: [{shape: box, size_m: [1, 0.1, 0.1], mass_kg: 2}]}]
    joints: [{name: top, type: hinge, bodies: [rope, world], anchor_m: [0, 0, 2], axis: [0, 1, 0]}]
actors: [{name: porter, object: gate, points: [[6, 0, 0.5], [6, 3, 0.5]], ends: reverse, speed_mps: 0.7}]
zones: [{name: dock, shape: box, position_m: [0, 0, 0], size_m: [3, 3, 3], finish: true, speed_limit_mps: 0.1}]
vehicles:
  - name: rover
    count: 2
    position_m: [0, -2, 0]
    placement: {pattern: line, spacing_m: 2}
    model: &model
      shoal: 1
      vehicle: cart
      clock: {preset: tcxo, update_s: 0.1}
      bodies:
        - {name: hull, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 5}]}
        - {name: left, position_m: [0, 0.3, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5, material: rubber}]}
        - {name: right, position_m: [0, -0.3, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5, material: rubber}]}
      joints:
        - {name: left, type: hinge, bodies: [hull, left], anchor_m: [0, 0.3, 0.1], axis: [0, 1, 0],
           motor_velocity: 4, motor_max_force: 3}
        - {name: right, type: hinge, bodies: [hull, right], anchor_m: [0, -0.3, 0.1], axis: [0, 1, 0],
           motor_velocity: 3, motor_max_force: 3}
      devices:
        - {name: imu, type: imu, rate_hz: 50, gyro_noise: {gaussian_std: 0.01, random_walk_std: 0.01}, latency_s: 0.02,
           jitter_s: 0.01}
        - {name: lidar, type: lidar, rate_hz: 10, beams: 20, range_std_m: 0.01}
        - {name: bumper, type: bumper, rate_hz: 20}
events:
  - {name: wind, every: 0.6, do: [{move: {name: swing, position_m: [-6, 4, 0.5], area_m: [1, 1, 0], random_yaw: true}}]}
  - {name: rain, every: 0.4, jitter_s: 0.1, probability: 0.7,
     do: [{add: {object: late, position_m: [0, 0, 2], area_m: [4, 4, 0]}}, {add: late_swing},
       {move: {name: late_swing, position_m: [-6, -4, 0.3]}}, {move: {name: crate1, position_m: [0, 0, 1], area_m: [2, 2, 1]}}]}
  - {name: sun, when: event rain fires, delay_s: 0.25, do: [{remove: late}, {remove: late_swing}]}
  - {name: knock, when: any touches crate2, do: [{log: knock}]}
)";

inline sim::VehicleInstance visitor(const sim::World& world, const std::string& name, double x_m) {
  const std::string yaml = "{name: " + name + ", position_m: [" + std::to_string(x_m) + R"(, -6, 0], model: {shoal: 1,
    vehicle: guest, materials: [{name: felt}], contacts: [{between: [felt, any], friction: 0.2}],
    bodies: [{name: hull, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: [0.3, 0.3, 0.3], mass_kg: 1, material: felt}]}],
    devices: [{name: imu, type: imu, rate_hz: 20, accel_noise: {bias_std: 0.1, gaussian_std: 0.1}},
              {name: pose, type: inclinometer, rate_hz: 10}]}})";
  return sim::read_spawn_request(world.config(), yaml).vehicle;
}

inline std::string error_of(sim::World& world, std::span<const std::byte> snapshot) {
  try {
    world.state().restore(snapshot);
    return {};
  } catch (const sim::SnapshotError& error) {
    return error.what();
  }
}

class DamagedSnapshot : public testing::Test {
 protected:
  DamagedSnapshot() {
    for (int i = 0; i < 30; ++i) world().step();
    world().editor().add_vehicle(visitor(world(), "guest", 0));
    for (int i = 0; i < 30; ++i) world().step();
    good = world().state().snapshot();
  }
  sim::World& world() { return test.world; }

  test::TappedWorld test{busy_world};
  sim::Bytes good;
};

}  // namespace busy_worlds
