// SPDX-License-Identifier: BSD-3-Clause
// The whole simulator on the scene `land`, and what its parts cost there.
#include <benchmark/benchmark.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "sim/config/file_access.hpp"
#include "sim/vehicle/stage_times.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "verification/bench/bench_run.hpp"
#include "verification/bench/rover_arena.hpp"

namespace {

/// One simulated second per iteration; the counter is CPU milliseconds per robot and simulated second.
void LandSceneSecond(benchmark::State& state) {
  const int robots = static_cast<int>(state.range(0));
  verification::BenchRun scene(verification::land_scene(), robots);
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
BENCHMARK(LandSceneSecond)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

enum Form { one_count, entries_of_a_file, inline_models };

/// Rovers on a plane; the first two forms name a shipped vehicle file.
std::string many_rovers(std::int64_t vehicles, std::int64_t form) {
  std::string text = "shoal: 1\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\nvehicles:\n";
  if (form == one_count)
    return text + fmt::format("  - {{name: rover, file: rover_small.yaml, count: {}, placement: {{spacing_m: 2}}}}\n",
                              vehicles);
  const std::string model = verification::rover_model_text("[0.24, 0, 0.04]");
  for (std::int64_t i = 0; i < vehicles; ++i)
    text += fmt::format("  - name: rover{}\n    position_m: [{}, {}, 0]\n    {}\n", i, i % 100 * 2, i / 100 * 2,
                        form == inline_models ? "model:" + model : "file: rover_small.yaml");
  return text;
}

/// Reads and builds a world of rovers.
void LoadVehicles(benchmark::State& state) {
  const std::string text = many_rovers(state.range(0), state.range(1));
  const std::string file = sim::shipped_folder() + "/worlds/many.yaml";
  for (auto _ : state) {
    const sim::LoadedWorld loaded = sim::load_world_text(text, file);
    sim::InProcessBus bus;
    const sim::World world(loaded.config, bus);
    benchmark::DoNotOptimize(world.vehicles().size());
  }
  state.counters["lines"] = static_cast<double>(std::count(text.begin(), text.end(), '\n'));
}
BENCHMARK(LoadVehicles)
    ->ArgNames({"vehicles", "form"})
    ->ArgsProduct({{1000, 10000}, {one_count, entries_of_a_file, inline_models}})
    ->Unit(benchmark::kMillisecond);

/// A rover comes into a world of others and goes again; both from the request's text on, with a step in between.
void SpawnAndRemove(benchmark::State& state) {
  const sim::LoadedWorld loaded = sim::load_world_text(verification::land_scene_text(static_cast<int>(state.range(0))),
                                                       "worlds/land.yaml", {{"limits.vehicles=20000"}, {}, false, {}});
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (int i = 0; i < 10; ++i) world.step();
  double spawn_s = 0, remove_s = 0, max_s = 0;
  const auto timed = [&](double& sum_s, const auto& work) {
    const double start_s = sim::StageClock::now_s();  // CPU time
    work();
    const double took_s = sim::StageClock::now_s() - start_s;
    sum_s += took_s;
    max_s = std::max(max_s, took_s);
  };
  for (auto _ : state) {
    timed(spawn_s, [&] {
      world.editor().add_vehicle(
          sim::read_spawn_request(world.config(), "{name: guest, file: rover.yaml, position_m: [0, 0, 50]}").vehicle);
    });
    world.step();
    timed(remove_s, [&] { world.editor().remove_vehicle("guest"); });
  }
  const auto iterations = static_cast<double>(state.iterations());
  state.counters["spawn_us"] = spawn_s * 1e6 / iterations;
  state.counters["remove_us"] = remove_s * 1e6 / iterations;
  state.counters["worst_us"] = max_s * 1e6;
}
BENCHMARK(SpawnAndRemove)->Arg(10)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

void StateHash(benchmark::State& state) {
  verification::BenchRun scene(verification::land_scene(), static_cast<int>(state.range(0)));
  scene.run_for(1);
  for (auto _ : state) benchmark::DoNotOptimize(scene.world().state().hash());
}
BENCHMARK(StateHash)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
