// SPDX-License-Identifier: BSD-3-Clause
// Questions to the medium, ns each.  A sea of 200 components for 100 boats at 50 Hz, each asking for the water at its
// origin and for the surface at four points, takes 5000 (water + 4 surface) a simulated second.
#include <benchmark/benchmark.h>

#include "sim/medium/medium.hpp"

namespace {

sim::MediumConfig config_of(int components, bool deep) {
  sim::MediumConfig config;
  config.water.emplace();
  config.current.emplace_back();
  config.current[0].velocity_mps = {0.3, 0.1, 0};
  if (components == 0) return config;
  config.waves.emplace();
  config.waves->components = components;
  config.waves->spreading = 10;
  if (!deep) config.waves->water_depth_m = 20;
  return config;
}

void walk(sim::Vector3d& p_W) {
  p_W.x() += 0.01;
}

/// Arguments: components (0: still water), depth in m.
void water_at(benchmark::State& state, bool deep) {
  const sim::Medium medium(config_of(static_cast<int>(state.range(0)), deep), 9.80665, 1);
  sim::Vector3d p_W(10, 20, -static_cast<double>(state.range(1)));
  for (auto _ : state) {
    walk(p_W);
    benchmark::DoNotOptimize(medium.water_at(p_W));
  }
}

void surface(benchmark::State& state) {
  const sim::Medium medium(config_of(static_cast<int>(state.range(0)), true), 9.80665, 1);
  sim::Vector3d p_W(10, 20, 0);
  for (auto _ : state) {
    walk(p_W);
    benchmark::DoNotOptimize(medium.surface_m(p_W.x(), p_W.y()));
  }
}

void advance(benchmark::State& state) {
  sim::Medium medium(config_of(static_cast<int>(state.range(0)), true), 9.80665, 1);
  sim::Time now{0};
  for (auto _ : state) {
    now += sim::Time{20000};
    medium.advance_to(now);
  }
}

/// 100 boats for a second of simulated time at 50 Hz; the time of an iteration is the share of real time.
void hundred_boats(benchmark::State& state) {
  sim::Medium medium(config_of(200, true), 9.80665, 1);
  sim::Time now{0};
  for (auto _ : state)
    for (int step = 0; step < 50; ++step) {
      now += sim::Time{20000};
      medium.advance_to(now);
      for (int boat = 0; boat < 100; ++boat) {
        const sim::Vector3d p_W(10 * boat, 0.02 * step, -0.2);
        benchmark::DoNotOptimize(medium.water_at(p_W));
        for (int corner = 0; corner < 4; ++corner)
          benchmark::DoNotOptimize(medium.surface_m(p_W.x() + corner, p_W.y()));
      }
    }
}

BENCHMARK_CAPTURE(water_at, deep_water, true)
    ->Args({0, 1})
    ->Args({1, 1})
    ->Args({200, 0})
    ->Args({200, 20})
    ->Args({200, 200});
BENCHMARK_CAPTURE(water_at, finite_depth, false)->Args({200, 1});
BENCHMARK(surface)->Arg(200);
BENCHMARK(advance)->Arg(0)->Arg(200);
BENCHMARK(hundred_boats)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
