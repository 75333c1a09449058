// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "verification/bench/bench_scene.hpp"

namespace verification {

/// Arena of wandering rovers, of the scenes `land` and `scale`: cells of 2 m (1 robot: one cell of 4 m; 10: 5 x 2; 100:
/// 10 x 10; 1000: 40 x 25; otherwise as square as possible), walls 0.1 m thick and 0.5 m high around it, robots / 4
/// fixed 0.5 m boxes of random yaw on cell corners, a rover in each cell (offset up to 0.4 m, random yaw).  A rover:
/// hull 0.5 x 0.4 m and 20 kg, from 0.08 m to 0.2 m above the ground, wheels 0.2 m in diameter, 180 rays over 180
/// degrees, 8 m, 10 Hz, 1 cm noise.
struct RoverArena {
  const char* name;             ///< of the world
  const char* lidar_position;   ///< m, in the frame of the chassis, 0.1 m above the ground
  bool one_entry_each = false;  ///< each rover has its own entry in the file, instead of one entry with a count
};

/// Returns the model of a rover as the value of `model:`, indented by six spaces.  `lidar_position`: such as `[0, 0,
/// 0.1]`; empty: without a lidar.
std::string rover_model_text(const std::string& lidar_position);

/// Returns the world file.
std::string rover_arena_text(const RoverArena& arena, int robots);

/// Returns the world file of the scene `land`.
std::string land_scene_text(int robots, bool one_entry_each = false);

/// Returns programs of all vehicles with a lidar and a drive: they wander, one step for each scan.
std::unique_ptr<ScenePrograms> wanderers(const sim::World& world, sim::Bus& bus);

}  // namespace verification
