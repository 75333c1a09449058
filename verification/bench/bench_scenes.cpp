// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "verification/bench/bench_scene.hpp"
#include "verification/bench/marine_helpers.hpp"
#include "verification/bench/rover_arena.hpp"

namespace verification {

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> all = {land_scene(),      scale_scene(),         crowd_scene(), sea_scene(),
                                              otters_scene(),    naive_scene(),         nav_scene(),   mixed_scene(),
                                              acoustics_scene(), acoustics_rays_scene()};
  return all;
}

const BenchScene* find_bench_scene(const std::string& name) {
  const auto& all = bench_scenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const BenchScene& scene) { return scene.name == name; });
  return found != all.end() ? &*found : nullptr;
}

std::string land_scene_text(int robots, bool one_entry_each) {
  // The lidar is at the front of the hull, 0.14 m above the ground, and so sees the hulls of others.
  return rover_arena_text({"land", "[0.24, 0, 0.04]", one_entry_each}, robots);
}

BenchScene land_scene() {
  return {"land",
          "rovers that wander among walls and boxes, with lidars of 180 rays at 10 Hz that see the other rovers",
          {1, 10, 100, 1000},
          [](int vehicles) { return land_scene_text(vehicles); },
          wanderers};
}

/// Kept for comparison with figures from before the scene `land` existed.
BenchScene scale_scene() {
  return {"scale",
          "as land, but the lidars stand above the hulls and see no rovers, which push each other; kept for comparison",
          {1, 10, 100, 1000},
          [](int vehicles) {
            return rover_arena_text({"scale", "[0.15, 0, 0.15]"}, vehicles);
          },
          wanderers};
}

BenchScene sea_scene() {
  return {"sea",
          "REMUS 100 by coefficients under water, with propeller, fins, and depth and heading at 1 Hz",
          {1, 100, 1000, 10000},
          [](int vehicles) {
            return marine_fleet_text({"sea", 0.02, "file: remus100_fleet.yaml"}, vehicles);
          },
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<StartCommands>(world, bus, set_off_remus);
          }};
}

BenchScene otters_scene() {
  return {"otters",
          "Otter boats by coefficients in a sea of 200 waves",
          {1, 10, 100},
          [](int vehicles) {
            return marine_fleet_text({"otters", 0.02, "file: otter.yaml",
                                      "waves: {type: jonswap, hs_m: 0.5, tp_s: 4, components: 200, spreading: 4}, ", 0},
                                     vehicles);
          },
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<StartCommands>(world, bus, set_off_otter);
          }};
}

BenchScene naive_scene() {
  return {"naive",
          "kinematic AUVs without a hull, with depth and heading at 1 Hz",
          {1, 100, 1000, 10000},
          [](int vehicles) {
            return marine_fleet_text(
                {"naive", 0.02,
                 "model: {shoal: 1, vehicle: naive, bodies: [{name: hull, kinematic: true, parts: []}], "
                 "devices: [{name: drive, type: naive_drive, start_speed_mps: 1.5}, "
                 "{name: depth, type: pressure, rate_hz: 1}, {name: heading, type: compass, rate_hz: 1}]}"},
                vehicles);
          },
          nullptr};
}

BenchScene nav_scene() {
  return {"nav",
          "REMUS 100 that localize themselves: autopilot, DVL, AHRS, pressure, GPS, silent modem, drifting clock",
          {1, 10, 100, 1000},
          [](int vehicles) {
            return marine_fleet_text(
                {"nav", 0.01, "file: remus100_nav.yaml", "", 20, 20,
                 "objects: [{name: bottom, fixed: true, position_m: [0, 0, -60], parts: [{shape: plane}]}]\n"},
                vehicles);
          },
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<StartCommands>(world, bus, set_off_autopilot);
          }};
}

}  // namespace verification
