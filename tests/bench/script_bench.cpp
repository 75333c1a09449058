// SPDX-License-Identifier: BSD-3-Clause
// What actors and events cost in a step.
#include <benchmark/benchmark.h>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

/// `count` objects in a square of 5 m spacing, each on its own round.
std::string crowd(int count, const std::string& path) {
  std::string objects = "objects:\n";
  std::string actors = "actors:\n";
  for (int i = 0; i < count; ++i) {
    const int x = 5 * (i % 25);
    const int y = 5 * (i / 25);
    const auto corner = [&](int dx, int dy) {
      return "[" + std::to_string(x + dx) + ", " + std::to_string(y + dy) + ", 0]";
    };
    const std::string name = "a" + std::to_string(i);
    objects += "  - {name: " + name + ", parts: [{shape: box, size_m: [0.5, 0.5, 0.5]}]}\n";
    actors += "  - {name: " + name + ", object: " + name + ", path: " + path + ", points: [" + corner(0, 0) + ", " +
              corner(2, 0) + ", " + corner(2, 2) + ", " + corner(0, 2) + "]}\n";
  }
  return "shoal: 1\n" + objects + (path == "none" ? "" : actors);
}

/// One step per iteration; items per second are steps per second.
void StepWithActors(benchmark::State& state, const std::string& path) {
  const sim::LoadedWorld loaded = sim::load_world_text(crowd(static_cast<int>(state.range(0)), path), "crowd.yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (auto _ : state) world.step();
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(StepWithActors, waypoints, std::string("waypoints"))->Arg(500)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(StepWithActors, spline, std::string("spline"))->Arg(500)->Unit(benchmark::kMicrosecond);

/// One step of a world in which `count` events have their times in other steps.
void StepWithWaitingEvents(benchmark::State& state) {
  std::string text = "shoal: 1\nevents:\n";
  for (int i = 0; i < state.range(0); ++i)
    text += "  - {name: e" + std::to_string(i) + ", every: 1000, do: [{gravity_mps2: 9.8}]}\n";
  const sim::LoadedWorld loaded = sim::load_world_text(text, "events.yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (auto _ : state) world.step();
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(StepWithWaitingEvents)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
