// SPDX-License-Identifier: BSD-3-Clause
// The whole simulator on the scale scene, and what its parts cost there.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/experiment/bench/scale_scene.hpp"

namespace {

/// One simulated second per iteration; the counter is CPU milliseconds per robot and simulated second.
void ScaleSceneSecond(benchmark::State& state) {
  const int robots = static_cast<int>(state.range(0));
  tools::ScaleScene scene(robots);
  scene.run_for(10);
  std::int64_t contacts = 0;
  for (auto _ : state) {
    scene.run_for(1);
    contacts += scene.world().physics().last_step().contacts;
  }
  state.counters["ms_per_robot_second"] = benchmark::Counter(static_cast<double>(state.iterations()) * robots * 1e-3,
                                                             benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["contacts_per_robot"] =
      static_cast<double>(contacts) / static_cast<double>(state.iterations()) / robots;
}
BENCHMARK(ScaleSceneSecond)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

/// Reads and builds a world of 1000 rovers, each its own entry (range 1) or one entry with a count (range 0).
void LoadThousandVehicles(benchmark::State& state) {
  const std::string text = tools::scale_scene_text(1000, state.range(0) == 1);
  for (auto _ : state) {
    const sim::LoadedWorld loaded = sim::load_world_text(text, "scale.yaml");
    sim::InProcessBus bus;
    const sim::World world(loaded.config, bus);
    benchmark::DoNotOptimize(world.vehicles().size());
  }
  state.counters["lines"] = static_cast<double>(std::count(text.begin(), text.end(), '\n'));
}
BENCHMARK(LoadThousandVehicles)->ArgName("one_entry_each")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// A rover comes into a world of 1000 others and goes again; both from the request's text on.
void SpawnAndRemove(benchmark::State& state) {
  const sim::LoadedWorld loaded =
      sim::load_world_text(tools::scale_scene_text(static_cast<int>(state.range(0)), false), "worlds/scale.yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (int i = 0; i < 10; ++i) world.step();
  double spawn_s = 0, remove_s = 0, max_s = 0;
  const auto timed = [&](double& sum_s, const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    sum_s += took_s;
    max_s = std::max(max_s, took_s);
  };
  for (auto _ : state) {
    timed(spawn_s, [&] {
      world.editor().add_vehicle(
          sim::read_spawn_request(world.config(), "{name: guest, file: rover.yaml, position_m: [0, 0, 50]}").vehicle);
    });
    timed(remove_s, [&] { world.editor().remove_vehicle("guest"); });
  }
  const auto iterations = static_cast<double>(state.iterations());
  state.counters["spawn_us"] = spawn_s * 1e6 / iterations;
  state.counters["remove_us"] = remove_s * 1e6 / iterations;
  state.counters["worst_us"] = max_s * 1e6;
}
BENCHMARK(SpawnAndRemove)->Arg(10)->Arg(1000)->Unit(benchmark::kMicrosecond);

void StateHash(benchmark::State& state) {
  tools::ScaleScene scene(static_cast<int>(state.range(0)));
  scene.run_for(1);
  for (auto _ : state) benchmark::DoNotOptimize(scene.world().state().hash());
}
BENCHMARK(StateHash)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
