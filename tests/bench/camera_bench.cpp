// SPDX-License-Identifier: BSD-3-Clause
// One frame: 320 x 240 in color with shadows and 640 x 480 of depth, among 1000 boxes strewn over 100 m x 100 m on a
// plane, on one core; in color also 8 m under water, with and without caustics and particles, and with two lamps.
#include <benchmark/benchmark.h>

#include <memory>
#include <random>

#include "sim/camera/renderer.hpp"
#include "sim/camera/water_view.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::RayLibrary;

std::unique_ptr<PhysicsWorld> strewn_boxes(int count, RayLibrary rays) {
  PhysicsConfig config;
  config.rays = rays;
  auto world = make_world(config);
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  add_ground(*world);
  for (int i = 0; i < count; ++i)
    add(*world, body("box" + std::to_string(i), {box({uniform(0.3, 1.5), uniform(0.3, 1.5), 2}, 0)}),
        sim::make_pose({uniform(0, 100), uniform(0, 100), 1}, {0, 0, uniform(0, 3)}), Motion::fixed);
  return world;
}

void frame(benchmark::State& state, sim::ImageKind kind, int width, int height, RayLibrary rays) {
  const auto world = strewn_boxes(static_cast<int>(state.range(0)), rays);
  sim::OpticsConfig lens;
  lens.width = width, lens.height = height;
  sim::RenderOptions options;
  options.kind = kind;
  sim::Renderer renderer(*world, sim::make_pixel_rays(sim::Optics(lens), 1), options,
                         std::make_shared<sim::TextureLibrary>());
  sim::Frame image;
  const Pose X_WS = sim::make_pose({10, 10, 2}, {0, 0.1, 0.8});
  for (auto _ : state) {
    renderer.render(X_WS, image);
    if (kind == sim::ImageKind::color) benchmark::DoNotOptimize(sim::develop(image.light, 1).data.data());
    benchmark::DoNotOptimize(image.depth_m.data.data());
  }
}

/// `details`: caustics and particles.
void wet_frame(benchmark::State& state, bool details, int lamps) {
  const auto world = strewn_boxes(1000, RayLibrary::embree);
  sim::MediumConfig medium_config;
  medium_config.water.emplace().surface_m = 10;
  const sim::Medium medium(medium_config, 9.81, 1);
  sim::WaterLook look{sim::water_optics(sim::JerlovType::II)};
  look.caustics = details;
  look.particles_per_m3 = details ? 500 : 0;
  sim::RenderOptions options;
  sim::WaterView water(medium, options.light, look);
  options.water = &water;
  options.with_depth = details;
  options.lamps.resize(static_cast<std::size_t>(lamps));
  sim::OpticsConfig lens;
  lens.width = 320, lens.height = 240;
  sim::Renderer renderer(*world, sim::make_pixel_rays(sim::Optics(lens), 1), options,
                         std::make_shared<sim::TextureLibrary>());
  sim::Frame image;
  const Pose X_WS = sim::make_pose({10, 10, 2}, {0, 0.1, 0.8});
  for (auto _ : state) {
    water.update(X_WS.translation());
    renderer.render(X_WS, image);
    benchmark::DoNotOptimize(sim::develop(image.light, 1).data.data());
  }
}

}  // namespace

BENCHMARK_CAPTURE(wet_frame, color_320x240_water, false, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(wet_frame, color_320x240_water_details, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(wet_frame, color_320x240_water_2_lamps, false, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, color_320x240, sim::ImageKind::color, 320, 240, RayLibrary::embree)
    ->Arg(10)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, depth_640x480, sim::ImageKind::depth, 640, 480, RayLibrary::embree)
    ->Arg(10)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, color_320x240_ode, sim::ImageKind::color, 320, 240, RayLibrary::ode)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
