// SPDX-License-Identifier: BSD-3-Clause
// Steps of worlds with bodies in buoyancy mode, ns a body and step, physics included.  The same bodies in a dry world
// are the base to compare with.
#include <benchmark/benchmark.h>

#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

constexpr int bodies = 100;

const char* still = "water: {}";
const char* sea = "water: {}, waves: {type: jonswap, hs_m: 1, tp_s: 5, components: 200}";

void step(benchmark::State& state, const std::string& medium, const std::string& part, double z_m) {
  const char* gravity = z_m > 50 ? "0" : "9.80665";  // in the air they would fall ever faster
  const std::string yaml = std::string("shoal: 1\nphysics: {step_s: 0.02, gravity_mps2: ") + gravity + "}\nmedium: {" +
                           medium + "}\nobjects:\n  - {name: it, count: " + std::to_string(bodies) +
                           ", placement: {pattern: grid, spacing_m: 10}, position_m: [0, 0, " + std::to_string(z_m) +
                           "], parts: [{" + part + "}]}\n";
  const auto loaded = sim::load_world_text(yaml, "worlds/bench.yaml", {});
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (auto _ : state) world.step();
  state.counters["per_body"] = benchmark::Counter(
      static_cast<double>(bodies), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const char* box = "shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410";
const char* sphere = "shape: sphere, radius_m: 0.3, density_kgpm3: 512.5";
const char* capsule = "shape: capsule, radius_m: 0.2, length_m: 1.6, rpy_deg: [0, 90, 0], density_kgpm3: 512.5";
const char* heavy = "shape: sphere, radius_m: 0.3, density_kgpm3: 512.5, added_mass_coefficient: 0.5";

BENCHMARK_CAPTURE(step, dry_world, "", "shape: box, size_m: [2, 1, 0.5], mass_kg: 1", 100);
BENCHMARK_CAPTURE(step, far_over_the_water, still, box, 100000);
BENCHMARK_CAPTURE(step, floating_box, still, box, 0.05);
BENCHMARK_CAPTURE(step, floating_sphere, still, sphere, 0);
BENCHMARK_CAPTURE(step, floating_capsule, still, capsule, 0);
BENCHMARK_CAPTURE(step, with_added_mass, still, heavy, 0);
BENCHMARK_CAPTURE(step, sinking_box, still, "shape: box, size_m: [2, 1, 0.5], density_kgpm3: 1026", -100);
BENCHMARK_CAPTURE(step, box_in_a_sea_of_200, sea, box, 0.05);

}  // namespace

BENCHMARK_MAIN();
