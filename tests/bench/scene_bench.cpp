// SPDX-License-Identifier: BSD-3-Clause
// Fans of 180 rays, ns per ray: in an arena of 1000 cells of 2 m, each with a rover and every other with a box as well,
// and among boxes strewn over 100 m x 100 m; with either library.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::RayLibrary;

constexpr int beams = 180;

struct Arena {
  Arena(int cells, RayLibrary rays) {
    PhysicsConfig config;
    config.rays = rays;
    world = make_world(config, {slippery()});
    add_ground(*world);
    const int side = static_cast<int>(std::ceil(std::sqrt(cells)));
    for (int i = 0; i < cells; ++i) {
      const double x = 2.0 * (i % side), y = 2.0 * (i / side);
      rovers.push_back(add_rover(*world, "rover" + std::to_string(i), translation(x, y, 0)));
      rovers.back().left->set_motor(3 + 0.1 * (i % 10), 5);
      rovers.back().right->set_motor(-2 + 0.1 * (i % 7), 5);
      if (i % 2 == 0)
        add(*world, body("box" + std::to_string(i), {box({0.2, 0.2, 0.6}, 0)}), translation(x + 1, y + 1, 0.3),
            Motion::fixed);
    }
    for (int i = 0; i < 100; ++i) world->step(step_number++);
  }
  /// A lidar on top of a rover, which does not see its own rover.
  void scan(int rover, std::vector<sim::RayHit>& hits) const {
    sim::Fan fan;
    fan.X_WS = rovers[rover].chassis->X_WB() * translation(0.1, 0, 0.02);
    fan.first_angle_rad = -std::numbers::pi / 2;
    fan.step_rad = std::numbers::pi / (beams - 1);
    fan.count = beams;
    fan.range_max_m = 8;
    world->scene().cast_fan(fan, {~0u, rovers[rover].chassis->group()}, hits);
  }
  std::unique_ptr<PhysicsWorld> world;
  std::vector<Rover> rovers;
  std::int64_t step_number = 0;
};

void per_ray(benchmark::State& state, double rays) {
  state.counters["ray"] = benchmark::Counter(rays, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void fan_in_arena(benchmark::State& state, RayLibrary library) {
  const Arena arena(static_cast<int>(state.range(0)), library);
  std::vector<sim::RayHit> hits(beams);
  int rover = 0;
  for (auto _ : state) {
    arena.scan(rover, hits);
    benchmark::DoNotOptimize(hits.data());
    rover = (rover + 1) % static_cast<int>(arena.rovers.size());
  }
  per_ray(state, static_cast<double>(state.iterations()) * beams);
}

/// As a run does it: a step, then one in ten rovers scans (10 Hz at 100 steps a second).
void step_and_scan(benchmark::State& state, RayLibrary library) {
  Arena arena(1000, library);
  std::vector<sim::RayHit> hits(beams);
  for (auto _ : state) {
    arena.world->step(arena.step_number++);
    for (int i = static_cast<int>(arena.step_number % 10); i < 1000; i += 10) arena.scan(i, hits);
  }
}

std::unique_ptr<PhysicsWorld> strewn_boxes(int count, RayLibrary library) {
  PhysicsConfig config;
  config.rays = library;
  auto world = make_world(config);
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  add_ground(*world);
  for (int i = 0; i < count; ++i)
    add(*world, body("box" + std::to_string(i), {box({uniform(0.3, 1.5), uniform(0.3, 1.5), 2}, 0)}),
        sim::make_pose({uniform(0, 100), uniform(0, 100), 1}, {0, 0, uniform(0, 3)}), Motion::fixed);
  return world;
}

void fan_among_boxes(benchmark::State& state, RayLibrary library) {
  const auto world = strewn_boxes(static_cast<int>(state.range(0)), library);
  std::mt19937 random(2);
  std::vector<sim::RayHit> hits(beams);
  for (auto _ : state) {
    sim::Fan fan;
    fan.X_WS = sim::make_pose({random() % 100 + 0.5, random() % 100 + 0.5, 0.5}, {0, 0, 0.01 * (random() % 628)});
    fan.first_angle_rad = -std::numbers::pi / 2;
    fan.step_rad = std::numbers::pi / (beams - 1);
    fan.count = beams;
    fan.range_max_m = 20;
    world->scene().cast_fan(fan, {}, hits);
    benchmark::DoNotOptimize(hits.data());
  }
  per_ray(state, static_cast<double>(state.iterations()) * beams);
}

void single_cast_among_boxes(benchmark::State& state, RayLibrary library) {
  const auto world = strewn_boxes(static_cast<int>(state.range(0)), library);
  std::mt19937 random(2);
  for (auto _ : state) {
    const double angle = 0.01 * (random() % 628);
    const Vector3d from(random() % 100 + 0.5, random() % 100 + 0.5, 0.5);
    benchmark::DoNotOptimize(world->scene().cast(from, {std::cos(angle), std::sin(angle), 0}, 20, {}));
  }
}

}  // namespace

BENCHMARK_CAPTURE(fan_in_arena, embree, RayLibrary::embree)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(fan_in_arena, ode, RayLibrary::ode)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(fan_among_boxes, embree, RayLibrary::embree)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(fan_among_boxes, ode, RayLibrary::ode)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(single_cast_among_boxes, embree, RayLibrary::embree)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(single_cast_among_boxes, ode, RayLibrary::ode)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(step_and_scan, embree, RayLibrary::embree)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step_and_scan, ode, RayLibrary::ode)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
