// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

/// Returns the world file of the benchmark scene: an arena of 2 m cells (1 robot: one 4 m cell; 10: 5 x 2; 100: 10 x
/// 10; 1000: 40 x 25; otherwise as square as possible), walls 0.1 m thick and 0.5 m high around it, robots / 4 fixed
/// 0.5 m boxes of random yaw on cell corners, a rover in each cell (offset up to 0.4 m, random yaw). A rover: body 0.4
/// x 0.5 m and 20 kg, wheels 0.2 m in diameter, 180 rays over 180 degrees, 8 m, 10 Hz, 1 cm noise. `one_entry_each`:
/// every rover has its own entry in the file, instead of one entry with a count.
std::string scale_scene_text(int robots, bool one_entry_each = false);

/// Running benchmark scene: rovers that wander in process at 10 Hz, all reports published on the in-process bus.
class ScaleScene {
 public:
  /// Throws ConfigError for invalid `sets` (path=value).
  explicit ScaleScene(int robots, const std::vector<std::string>& sets = {}, int threads = 1);
  ~ScaleScene();
  /// Takes one step of the world, and lets the wanderers react to new scans.
  void step();
  void run_for(double time_s);
  sim::World& world() { return *world_; }
  const sim::World& world() const { return *world_; }
  const sim::InProcessBus& bus() const { return bus_; }

 private:
  struct Wanderer;
  sim::LoadedWorld loaded_;
  sim::InProcessBus bus_;
  std::unique_ptr<sim::World> world_;
  std::vector<std::unique_ptr<Wanderer>> wanderers_;
};

/// Performance figures of one run of the scale scene.
struct ScaleFigures {
  int robots = 0;
  double load_s = 0;                   ///< wall time to read and build the world
  double cpu_ms_per_robot_second = 0;  ///< CPU milliseconds per robot and simulated second
  double real_time_factor = 0;
  std::uint64_t run_hash = 0;
};

struct ScaleOptions {
  double warm_up_s = 10;          ///< simulated time before the measurement
  double measure_s = 20;          ///< simulated time measured
  int threads = 1;                ///< see World::use_threads
  std::vector<std::string> sets;  ///< path=value
};

/// Loads the scene, runs the warm-up, and measures.
ScaleFigures measure_scale(int robots, const ScaleOptions& options);

}  // namespace tools
