// SPDX-License-Identifier: BSD-3-Clause
// Fleets in water with a current: what a step of one vehicle costs, in CPU time, reports to the in-process bus.
#include <benchmark/benchmark.h>

#include <string>

#include "shoal/actuator_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace {

/// `vehicle`: `file: ...` or `model: {...}`, indented by four spaces.
std::string world_text(std::int64_t vehicles, double step_s, const std::string& vehicle) {
  return "shoal: 1\nphysics: {step_s: " + std::to_string(step_s) +
         "}\nmedium: {water: {}, current: [{velocity_mps: [0.2, 0.1, 0]}]}\n"
         "vehicles:\n  - name: auv\n    count: " +
         std::to_string(vehicles) +
         "\n    position_m: [0, 0, -20]\n    placement: {pattern: grid, spacing_m: 5}\n    " + vehicle + "\n";
}

const std::string worlds = test_support::source_path("worlds/bench.yaml");

/// Propellers and fins of a fleet at work.
void set_off(sim::World& world, sim::Bus& bus) {
  for (const auto& vehicle : world.vehicles()) {
    const auto send = [&](const std::string& device, double value) {
      bus.publish(vehicle->name() + "." + device + ".cmd", shoal::encode(shoal::actuator_command_t{0, value}),
                  world.now());
    };
    send("propeller", 1100 + 10 * (vehicle->number() % 20));
    send("rudder", 0.01 * (vehicle->number() % 7 - 3));
    send("stern_planes", 0.002 * (vehicle->number() % 5 - 2));
  }
}

void run(benchmark::State& state, const std::string& text, double step_s, bool commanded, int threads = 1) {
  const sim::LoadedWorld loaded = sim::load_world_text(text, worlds);
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  world.use_threads(threads);
  if (commanded) set_off(world, bus);
  for (int i = 0; i < 200; ++i) world.step();
  for (auto _ : state) world.step();
  const auto vehicles = static_cast<double>(state.range(0));
  state.counters["us_per_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * vehicles * 1e-6,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["times_real"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * step_s, benchmark::Counter::kIsRate);
}

/// REMUS 100 by coefficients, with strips, propeller, fins, depth and heading at 1 Hz, and a hull that can collide.
void Remus(benchmark::State& state) {
  run(state, world_text(state.range(0), 0.02, "file: remus100_fleet.yaml"), 0.02, true);
}
BENCHMARK(Remus)->Arg(1)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

/// REMUS 100 with the sensors of navigation: autopilot, DVL, AHRS, pressure, GPS, acoustic modem, a drifting clock; at
/// a step of 10 ms.  `state.range(1)`: threads.  A simulated second of a vehicle takes a hundred times us_per_step.
void RemusNav(benchmark::State& state) {
  run(state, world_text(state.range(0), 0.01, "file: remus100_nav.yaml"), 0.01, false,
      static_cast<int>(state.range(1)));
}
BENCHMARK(RemusNav)
    ->ArgNames({"vehicles", "threads"})
    ->ArgsProduct({{1, 10, 100, 1000}, {1}})
    ->ArgsProduct({{1000}, {2, 4, 8}})
    ->Unit(benchmark::kMicrosecond);

/// Boats by coefficients in a sea of 200 waves.
void OttersInASea(benchmark::State& state) {
  std::string text = world_text(state.range(0), 0.02, "file: otter.yaml");
  const std::string calm = "medium: {water: {}, ";
  text.replace(text.find(calm), calm.size(),
               calm + "waves: {type: jonswap, hs_m: 0.5, tp_s: 4, components: 200, spreading: 4}, ");
  text.replace(text.find("[0, 0, -20]"), 11, "[0, 0, 0]");
  run(state, text, 0.02, false);
}
BENCHMARK(OttersInASea)->Arg(1)->Arg(100)->Unit(benchmark::kMicrosecond);

/// The naive mode alone: a body without parts that nothing reports.
void Naive(benchmark::State& state) {
  run(state,
      world_text(state.range(0), 0.02,
                 "model: {shoal: 1, vehicle: naive, bodies: [{name: hull, kinematic: true, parts: []}], "
                 "devices: [{name: drive, type: naive_drive, start_speed_mps: 1.5}]}"),
      0.02, false);
}
BENCHMARK(Naive)->Arg(1)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

/// Naive AUVs with depth and heading at 1 Hz, without a hull that can collide.
void NaiveFleet(benchmark::State& state) {
  run(state,
      world_text(state.range(0), 0.02,
                 "model: {shoal: 1, vehicle: naive, bodies: [{name: hull, kinematic: true, parts: []}], "
                 "devices: [{name: drive, type: naive_drive, start_speed_mps: 1.5}, "
                 "{name: depth, type: pressure, rate_hz: 1}, {name: heading, type: compass, rate_hz: 1}]}"),
      0.02, false);
}
BENCHMARK(NaiveFleet)->Arg(1)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

/// The same as shipped: with a hull.
void NaiveAuv(benchmark::State& state) {
  run(state, world_text(state.range(0), 0.02, "file: naive_auv.yaml"), 0.02, false);
}
BENCHMARK(NaiveAuv)->Arg(100)->Arg(10000)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
