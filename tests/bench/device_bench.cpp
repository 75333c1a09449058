// SPDX-License-Identifier: BSD-3-Clause
// What the device layer costs: measure, disturb, encode and publish on the in-process bus.
#include <benchmark/benchmark.h>

#include <chrono>
#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

/// Weightless boxes far apart, so that physics has next to nothing to do.
std::string boxes(int count, const std::string& devices) {
  return "shoal: 1\nphysics: {step_s: 0.005, gravity_mps2: 0}\nvehicles:\n"
         "  - name: v\n    count: " +
         std::to_string(count) +
         "\n    placement: {pattern: grid, spacing_m: 5}\n    model: {shoal: 1, vehicle: box, bodies: [{name: hull, "
         "parts: "
         "[{shape: box, mass_kg: 1}]}], devices: [" +
         devices + "]}\n";
}

class Boxes {
 public:
  explicit Boxes(const std::string& devices)
      : loaded_(sim::load_world_text(boxes(1000, devices), "bench.yaml")), world_(loaded_.config, bus_) {
    for (int i = 0; i < 10; ++i) world_.step();
  }
  double step_s() {
    const auto start = std::chrono::steady_clock::now();
    world_.step();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  sim::LoadedWorld loaded_;
  sim::InProcessBus bus_;
  sim::World world_;
};

/// An IMU at 200 Hz on each of 1000 boxes.  The time is that of World::step less that of a world without IMUs, so the
/// reported time is one scalar reading: 6 of them in a sample.
void ImuLayer(benchmark::State& state, const std::string& errors) {
  Boxes with("{name: imu, type: imu, rate_hz: 200" + errors + "}");
  Boxes without("");
  double layer_s = 0;
  for (auto _ : state) {
    const double difference_s = with.step_s() - without.step_s();
    layer_s += difference_s;
    state.SetIterationTime(std::max(difference_s, 1e-9));
  }
  state.counters["ns_per_scalar"] = layer_s * 1e9 / (static_cast<double>(state.iterations()) * 1000 * 6);
}
void BM_ImuLayer(benchmark::State& state) {
  ImuLayer(state, "");
}
void BM_ImuLayerWithNoise(benchmark::State& state) {
  ImuLayer(state, ", preset: adis16470");
}
void BM_ImuLayerWithEverything(benchmark::State& state) {
  ImuLayer(state,
           ", preset: bmi088, bandwidth_Hz: 50, gyro_noise: {gaussian_std: 1e-3, gauss_markov_std: 1e-4}, "
           "accel_noise: {gaussian_std: 1e-2, gauss_markov_std: 1e-3}, accel_bias_instability_ug: 20");
}
BENCHMARK(BM_ImuLayer)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(400);
BENCHMARK(BM_ImuLayerWithNoise)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(400);
BENCHMARK(BM_ImuLayerWithEverything)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(400);

}  // namespace

BENCHMARK_MAIN();
