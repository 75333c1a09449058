// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/bench_run.hpp"

#include "sim/config/file_access.hpp"
#include "sim/vehicle/stage_times.hpp"
#include "sim/world/world_state.hpp"

namespace verification {

namespace {

/// Name of the world's file, so that shipped vehicle files are found as beside a shipped world.
std::string bench_world_file(const BenchScene& scene) {
  const std::string folder = sim::shipped_folder();
  return (folder.empty() ? "" : folder + "/worlds/") + scene.name + ".yaml";
}

}  // namespace

BenchRun::BenchRun(const BenchScene& scene, int vehicles, const std::vector<std::string>& sets, int threads)
    : loaded_(sim::load_world_text(scene.world_text(vehicles), bench_world_file(scene), {sets, {}, false, {}})),
      world_(loaded_.config) {
  world_.use_threads(threads);
  if (scene.programs != nullptr) programs_ = scene.programs(world_, world_.own_bus);
  if (programs_) programs_->think({});
}

BenchRun::~BenchRun() = default;

void BenchRun::step() {
  world_.step();
  if (!programs_) return;
  if (!measures_) return programs_->think(world_.now());
  const double start_s = sim::StageClock::now_s();
  programs_->think(world_.now());
  programs_s_ += sim::StageClock::now_s() - start_s;
}

void BenchRun::run_for(double time_s) {
  const sim::Time end = world_.now() + sim::from_seconds(time_s);
  while (world_.now() < end) step();
}

void BenchRun::measure_stages(sim::StageTimes* times) {
  measures_ = times != nullptr;
  world_.state().measure_stages(times);
}

}  // namespace verification
