// The whole simulator on the scale scene, and what its parts cost there.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "sim/world/load_world.hpp"
#include "tools/experiment/scale_scene.hpp"

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

/// Reads and builds a world of 1000 rovers, each an entry of its own (range 1) or one entry with a count (range 0).
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

void StateHash(benchmark::State& state) {
  tools::ScaleScene scene(static_cast<int>(state.range(0)));
  scene.run_for(1);
  for (auto _ : state) benchmark::DoNotOptimize(scene.world().state_hash());
}
BENCHMARK(StateHash)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
