// Marine vehicles in still water with a current: what a step of one of them costs, in CPU time.
#include <benchmark/benchmark.h>

#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/load_world.hpp"
#include "sim/world/world.hpp"

namespace {

std::string world_text(int vehicles, const std::string& body, const std::string& devices) {
  return "shoal: 1\nphysics: {step_s: 0.02}\n"
         "medium: {water: {}, current: {velocity_mps: [0.2, 0.1, 0]}}\n"
         "vehicles:\n  - name: auv\n    count: " +
         std::to_string(vehicles) +
         "\n    position_m: [0, 0, -20]\n    placement: {pattern: grid, spacing_m: 5}\n"
         "    model:\n      shoal: 1\n      vehicle: bench\n      bodies:\n" +
         body + "      devices:\n" + devices;
}

const char* remus = R"(
        - name: hull
          hydrodynamics:
            frame: frd
            mass_kg: 31.9
            inertia_kgm2: [0.117, 4.22, 4.22]
            center_of_mass_m: [0, 0, 0.02]
            added_mass: [0.863, 30.29, 30.29, 0.0352, 3.594, 3.594]
            linear_damping: [1.638, 3.11, 3.11, 0.611, 11.2, 7.81]
            cross_flow: {length_m: 1.6, height_m: 0.19, reynolds_length_m: 1.6,
                         drag_coefficient: [10211, 0.80, 60881, 0.80, 149262, 0.80, 200000, 0.80, 200000, 0.98,
                                            297098, 0.90, 409798, 0.57, 578922, 0.27, 1068686, 0.32, 4937305, 0.55]}
            hull_lift: {area_m2: 0.2128, lift_slope: 0.266, drag_coefficient: 0.057, induced_drag: 6.25}
          parts: [PARTS]
)";

std::string with_parts(bool parts) {
  std::string text = remus;
  text.replace(text.find("PARTS"), 5,
               parts ? "{shape: capsule, radius_m: 0.095, length_m: 1.4, rpy_deg: [0, 90, 0]}" : "");
  return text;
}

const char* sensors = R"(
        - {name: heading, type: compass, rate_hz: 1}
        - {name: depth, type: inclinometer, rate_hz: 1}
)";

void run(benchmark::State& state, const std::string& text) {
  const sim::LoadedWorld loaded = sim::load_world_text(text, "worlds/bench.yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  for (int i = 0; i < 100; ++i) world.step();
  for (auto _ : state) world.step();
  const auto vehicles = static_cast<double>(state.range(0));
  state.counters["us_per_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * vehicles * 1e-6,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["times_real"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * 0.02, benchmark::Counter::kIsRate);
}

void Coefficients(benchmark::State& state) {
  run(state, world_text(static_cast<int>(state.range(0)), with_parts(state.range(1) != 0),
                        state.range(2) != 0 ? sensors : "        []\n"));
}
BENCHMARK(Coefficients)
    ->ArgNames({"vehicles", "parts", "sensors"})
    ->ArgsProduct({{1, 100, 10000}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

void Naive(benchmark::State& state) {
  const bool parts = state.range(1) != 0;
  run(state,
      world_text(static_cast<int>(state.range(0)),
                 std::string("        - name: hull\n          kinematic: true\n          parts: [") +
                     (parts ? "{shape: capsule, radius_m: 0.095, length_m: 1.4, rpy_deg: [0, 90, 0]}" : "") + "]\n",
                 std::string("        - {name: drive, type: naive_drive, start_speed_mps: 1.5}\n") +
                     (state.range(2) != 0 ? sensors : "")));
}
BENCHMARK(Naive)
    ->ArgNames({"vehicles", "parts", "sensors"})
    ->ArgsProduct({{1, 100, 10000}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
