// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/world/world.hpp"

namespace verification {

/// Programs of a bench scene, connected to the bus like external ones.
class ScenePrograms {
 public:
  virtual ~ScenePrograms() = default;
  /// Called once before the first step and then after each step: takes reports and publishes commands.
  virtual void think(sim::Time now) = 0;
};

/// Scene of `shoal bench`: a world that grows with the number of its vehicles.
struct BenchScene {
  std::string name;              ///< on the command line
  std::string about;             ///< one line for the help
  std::vector<int> usual_sizes;  ///< numbers of vehicles measured by default
  /// Returns the world file.  It may name shipped vehicle files.
  std::string (*world_text)(int vehicles);
  /// Returns the programs of its vehicles; null: it has none.  World and bus outlive them.
  std::unique_ptr<ScenePrograms> (*programs)(const sim::World& world, sim::Bus& bus);
};

// Each is in a file of its name: scene_NAME.cpp.  A new one also needs a line in bench_scenes.cpp.
BenchScene land_scene();
BenchScene scale_scene();
BenchScene crowd_scene();
BenchScene sea_scene();
BenchScene otters_scene();
BenchScene naive_scene();
BenchScene nav_scene();
BenchScene acoustics_scene();
BenchScene acoustics_rays_scene();
BenchScene mixed_scene();

/// Returns all scenes, in the order of the help.
const std::vector<BenchScene>& bench_scenes();
/// Returns a scene by its name; null when there is none.
const BenchScene* find_bench_scene(const std::string& name);

}  // namespace verification
