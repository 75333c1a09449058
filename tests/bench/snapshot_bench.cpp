// SPDX-License-Identifier: BSD-3-Clause
// What it costs to save a world, to go back to it, and to hash it; per body and as a whole.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "experiment/snapshot/snapshot_ring.hpp"
#include "sim/world/world_state.hpp"
#include "verification/bench/bench_run.hpp"

namespace {

/// A world of so many rovers (three bodies, two joints, six devices each) that has run for a while.
verification::BenchRun& scene_of(int robots) {
  static std::map<int, std::unique_ptr<verification::BenchRun>> scenes;
  std::unique_ptr<verification::BenchRun>& scene = scenes[robots];
  if (!scene) {
    scene = std::make_unique<verification::BenchRun>(verification::land_scene(), robots);
    scene->run_for(2);
  }
  return *scene;
}

int bodies_of(const sim::World& world) {
  int count = 0;
  for (const auto& body : world.physics().bodies()) count += body && !body->fixed();
  return count;
}

void count_bodies(benchmark::State& state, const sim::World& world) {
  state.counters["bodies"] = bodies_of(world);
  state.counters["us_per_body"] = benchmark::Counter(static_cast<double>(state.iterations()) * bodies_of(world) * 1e-6,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void Snapshot(benchmark::State& state) {
  const sim::World& world = scene_of(static_cast<int>(state.range(0))).world();
  std::size_t bytes = 0;
  for (auto _ : state) {
    const sim::Bytes snapshot = world.state().snapshot();
    bytes = snapshot.size();
    benchmark::DoNotOptimize(snapshot.data());
  }
  state.counters["bytes"] = static_cast<double>(bytes);
  count_bodies(state, world);
}
BENCHMARK(Snapshot)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

/// In the world that continued, which saves itself first, so that it can stay as it is when the snapshot does not fit.
void Restore(benchmark::State& state) {
  sim::World& world = scene_of(static_cast<int>(state.range(0))).world();
  const sim::Bytes snapshot = world.state().snapshot();
  for (auto _ : state) world.state().restore(snapshot);
  count_bodies(state, world);
}
BENCHMARK(Restore)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void Hash(benchmark::State& state) {
  const sim::World& world = scene_of(static_cast<int>(state.range(0))).world();
  for (auto _ : state) benchmark::DoNotOptimize(world.state().hash());
  count_bodies(state, world);
}
BENCHMARK(Hash)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void HashByPart(benchmark::State& state) {
  const sim::World& world = scene_of(static_cast<int>(state.range(0))).world();
  for (auto _ : state) benchmark::DoNotOptimize(world.state().part_hashes().size());
  count_bodies(state, world);
}
BENCHMARK(HashByPart)->Arg(10)->Arg(1000)->Unit(benchmark::kMicrosecond);

/// Boxes and nothing else: what a body costs by itself.
void SnapshotOfBoxes(benchmark::State& state) {
  const std::string text = "shoal: 1\nobjects:\n  - {name: box, count: " + std::to_string(state.range(0)) +
                           ", placement: {pattern: grid}, parts: [{shape: box, mass_kg: 1}]}\n";
  const sim::LoadedWorld loaded = sim::load_world_text(text, "boxes.yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (int i = 0; i < 10; ++i) world.step();
  std::size_t bytes = 0;
  for (auto _ : state) bytes = world.state().snapshot().size();
  state.counters["bytes"] = static_cast<double>(bytes);
  count_bodies(state, world);
}
BENCHMARK(SnapshotOfBoxes)->Arg(10)->Arg(1000)->Unit(benchmark::kMicrosecond);

/// What a run keeps to go back by: one snapshot a second for ten minutes of a world in which all move, and then half a
/// minute back and half a second on.
void RingOfTenMinutes(benchmark::State& state) {
  constexpr int seconds = 600;
  verification::BenchRun scene(verification::land_scene(), static_cast<int>(state.range(0)));
  sim::World& world = scene.world();
  const std::int64_t per_second = std::llround(1 / sim::to_seconds(world.step_time()));
  experiment::SnapshotRing ring(seconds * per_second, std::size_t{64} << 20);
  const auto wall_s = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  double save_s = 0, max_s = 0, back_s = 0;
  std::size_t whole_bytes = 0;
  for (auto _ : state) {
    for (int second = 0; second < seconds; ++second) {
      scene.run_for(1);
      const double start_s = wall_s();
      const sim::Bytes snapshot = world.state().snapshot();
      ring.add(world.step_number(), snapshot);
      const double took_s = wall_s() - start_s;
      save_s += took_s;
      max_s = std::max(max_s, took_s);
      whole_bytes = snapshot.size();
    }
    const double start_s = wall_s();
    const std::int64_t to = world.step_number() - 30 * per_second - per_second / 2;
    world.state().restore(ring.get(*ring.newest_until(to)));
    while (world.step_number() < to) world.step();
    back_s = wall_s() - start_s;
  }
  state.counters["bytes"] = static_cast<double>(whole_bytes);
  state.counters["MB_of_600"] = static_cast<double>(ring.bytes()) * 1e-6;
  state.counters["kept"] = static_cast<double>(ring.size());
  state.counters["us_each"] = 1e6 * save_s / seconds;
  state.counters["us_longest"] = 1e6 * max_s;
  state.counters["back_30s_ms"] = 1e3 * back_s;
}
BENCHMARK(RingOfTenMinutes)->Arg(10)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace

BENCHMARK_MAIN();
