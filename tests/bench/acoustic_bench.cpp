// SPDX-License-Identifier: BSD-3-Clause
// Fleets that talk under water beside kinematic vehicles: each sends 32 bytes every 10 s, one after the other, so that
// what is sent overlaps at many receivers.  Work grows with who receives, which `hearers` counts for each message.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/acoustics/channel.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace {

constexpr double step_s = 0.02;
constexpr double period_s = 10;

/// A thermocline below the vehicles, which refracts sound.
constexpr const char* warm_above =
    "{profile: [{depth_m: 0, temperature_C: 16}, {depth_m: 25, temperature_C: 15.9}, {depth_m: 40, temperature_C: "
    "10}]}";

std::string world_text(std::int64_t vehicles, double spacing_m, const std::string& acoustics,
                       const std::string& water) {
  return "shoal: 1\nphysics: {step_s: " + std::to_string(step_s) + "}\nmedium: {water: " + water +
         ", current: [{velocity_mps: [0.2, 0.1, 0]}], wind: {velocity_mps: [5, 0, 0]}}\n"
         "acoustics: " +
         acoustics + "\nobjects: [{name: bottom, fixed: true, position_m: [0, 0, -60], parts: [{shape: plane}]}]\n" +
         "vehicles:\n  - name: auv\n    count: " + std::to_string(vehicles) +
         "\n    position_m: [0, 0, -20]\n    placement: {pattern: grid, spacing_m: " + std::to_string(spacing_m) +
         "}\n    model:\n      shoal: 1\n      vehicle: talker\n      bodies:\n"
         "        - {name: hull, kinematic: true, parts: [{shape: capsule, radius_m: 0.095, length_m: 1.41, "
         "rpy_deg: [0, 90, 0]}]}\n      devices:\n"
         "        - {name: drive, type: naive_drive, start_speed_mps: 1.5}\n"
         "        - {name: heading, type: compass, rate_hz: 1}\n"
         "        - {name: modem, type: acoustic_modem, preset: micromodem_rate0, rate_hz: 5}\n";
}

void talk(benchmark::State& state, double spacing_m, const std::string& acoustics, const std::string& water = "{}") {
  const std::int64_t vehicles = state.range(0);
  const sim::LoadedWorld loaded = sim::load_world_text(world_text(vehicles, spacing_m, acoustics, water),
                                                       test_support::source_path("worlds/bench.yaml"));
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  shoal::modem_send_t message{};
  message.data.assign(32, 1);
  message.size = 32;
  const sim::Bytes payload = shoal::encode(message);
  std::int64_t next = 0;
  const auto step = [&] {
    // Vehicle k asks at k / N of the period.
    while (static_cast<double>(next) * period_s / static_cast<double>(vehicles) <= sim::to_seconds(world.now()))
      bus.publish("auv" + std::to_string(next++ % vehicles + 1) + ".modem.cmd", payload, world.now());
    world.step();
  };
  while (sim::to_seconds(world.now()) < 2 * period_s) step();
  const std::int64_t flights = world.acoustics().flights(), sent = next;
  for (auto _ : state) step();
  state.counters["times_real"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * step_s, benchmark::Counter::kIsRate);
  state.counters["hearers"] = static_cast<double>(world.acoustics().flights() - flights) /
                              static_cast<double>(std::max<std::int64_t>(1, next - sent));
  state.counters["us_per_hearer"] =
      benchmark::Counter(static_cast<double>(world.acoustics().flights() - flights) * 1e-6,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// All within 5 km, so that everyone receives everyone.
void EverybodyHears(benchmark::State& state) {
  talk(state, 3000.0 / std::sqrt(static_cast<double>(state.range(0))), "{}");
}
BENCHMARK(EverybodyHears)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->MinTime(2);

/// The same with echoes of surface and bottom.
void EverybodyHearsEchoes(benchmark::State& state) {
  talk(state, 3000.0 / std::sqrt(static_cast<double>(state.range(0))), "{multipath: {}}");
}
BENCHMARK(EverybodyHearsEchoes)->Arg(100)->Arg(1000)->MinTime(2);

/// The same with rays through a thermocline.
void EverybodyHearsRays(benchmark::State& state) {
  talk(state, 3000.0 / std::sqrt(static_cast<double>(state.range(0))), "{}", warm_above);
}
BENCHMARK(EverybodyHearsRays)->Arg(100)->Arg(1000)->MinTime(2);

/// One every 2 km: how many receive does not grow with the fleet.
void NeighborsHear(benchmark::State& state) {
  talk(state, 2000, "{}");
}
BENCHMARK(NeighborsHear)->Arg(100)->Arg(1000)->Arg(10000)->MinTime(2);

}  // namespace

BENCHMARK_MAIN();
