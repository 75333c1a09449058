// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/world/standalone_world.hpp"
#include "sim/world_file/load_world.hpp"
#include "verification/bench/bench_scene.hpp"

namespace sim {
struct StageTimes;
}

namespace verification {

/// Running bench scene: a world and the programs of its vehicles in one process, all messages on the in-process
/// bus.
class BenchRun {
 public:
  /// `sets`: path=value.  Throws ConfigError for an invalid one, and when the world needs more memory than is free.
  BenchRun(const BenchScene& scene, int vehicles, const std::vector<std::string>& sets = {}, int threads = 1);
  ~BenchRun();
  /// Takes one step of the world, and lets the programs react to new messages.
  void step();
  void run_for(double time_s);
  sim::World& world() { return world_; }
  const sim::World& world() const { return world_; }
  const sim::InProcessBus& bus() const { return world_.own_bus; }
  /// CPU time of the programs since the start, while measured.
  double programs_s() const { return programs_s_; }
  /// Adds the times of the stages of each step to `times` from now on, and measures the programs; null: no longer.
  void measure_stages(sim::StageTimes* times);

 private:
  sim::LoadedWorld loaded_;
  sim::StandaloneWorld world_;
  std::unique_ptr<ScenePrograms> programs_;
  bool measures_ = false;
  double programs_s_ = 0;
};

}  // namespace verification
