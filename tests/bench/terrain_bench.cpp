// SPDX-License-Identifier: BSD-3-Clause
// One contact of a shape with terrain, us per dCollide, and what it takes to build terrain.  The ground is fractal with
// hills of 4 m and 0.1 m amplitude.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <memory>
#include <string>
#include <vector>

#include "sim/collision/terrain_geom.hpp"
#include "sim/ode/ode_math.hpp"
#include "tests/sim/terrain/terrain_worlds.hpp"

namespace {

using namespace terrain_worlds;

PartConfig bumps(double cell_m, TerrainCollision collision, double size_m) {
  PartConfig part = terrain(TerrainSource::fractal, cell_m, collision);
  part.terrain->size_m = {size_m, size_m};
  part.terrain->amplitude_m = 0.1;
  part.terrain->wavelength_m = 4;
  return part;
}

struct Ground {
  explicit Ground(const PartConfig& part) : terrain((sim::start_ode(), part), "ground", table, meshes) {
    geom = sim::make_terrain_geom(terrain);
  }
  sim::ContactTable table{{}, {}};
  sim::MeshCache meshes;
  sim::CollisionTerrain terrain;
  sim::GeomHandle geom;
};

sim::GeomHandle make_shape(int kind) {
  dMatrix3 R;
  sim::to_ode(sim::rotation_from_rpy({std::numbers::pi / 2, 0, 0}), R);
  sim::GeomHandle geom(kind == 0   ? dCreateSphere(nullptr, 0.1)
                       : kind == 1 ? dCreateCylinder(nullptr, 0.1, 0.06)
                       : kind == 2 ? dCreateSphere(nullptr, 0.35)
                       : kind == 3 ? dCreateCylinder(nullptr, 0.35, 0.2)
                                   : dCreateBox(nullptr, 4, 2, 0.5));
  if (kind == 1 || kind == 3) dGeomSetRotation(geom.get(), R);
  return geom;
}

/// Arguments: shape, size of the cells in mm.
template <TerrainCollision collision>
void contact(benchmark::State& state) {
  const int kind = static_cast<int>(state.range(0));
  const double half_height_m = kind < 2 ? 0.1 : kind < 4 ? 0.35 : 0.25;
  const Ground ground(bumps(static_cast<double>(state.range(1)) / 1000, collision, 20));
  const sim::GeomHandle shape = make_shape(kind);
  std::vector<dContactGeom> contacts(8);
  std::int64_t touched = 0;
  double x = -5;
  for (auto _ : state) {
    x = x > 5 ? -5 : x + 0.013;
    dGeomSetPosition(shape.get(), x, 0.3 * x, ground.terrain.terrain.grid.height(x, 0.3 * x) + half_height_m - 0.002);
    touched += dCollide(ground.geom.get(), shape.get(), 8, contacts.data(), sizeof(dContactGeom));
  }
  state.counters["contacts"] = static_cast<double>(touched) / static_cast<double>(state.iterations());
  const char* shapes[] = {"sphere 0.1", "cylinder 0.1", "sphere 0.35", "cylinder 0.35", "box 4x2x0.5"};
  state.SetLabel(std::string(word_of(sim::terrain_collision_words, collision)) + ", " + shapes[kind]);
}

void shapes_and_cells(benchmark::internal::Benchmark* bench) {
  bench->ArgsProduct({{0, 1, 2, 3, 4}, {50, 100, 250, 1000}})->Unit(benchmark::kMicrosecond);
}
BENCHMARK(contact<TerrainCollision::smooth>)->Name("smooth")->Apply(shapes_and_cells);
BENCHMARK(contact<TerrainCollision::facets>)->Name("facets")->Apply(shapes_and_cells);
BENCHMARK(contact<TerrainCollision::mesh>)->Name("mesh")->Apply(shapes_and_cells);

/// Peak memory of the process so far, MB.
double peak_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Arguments: points a side; 0 smooth, 1 facets, 2 mesh.  Memory is the growth of the peak: run one at a time, by
/// --benchmark_filter.
void build(benchmark::State& state) {
  const auto collision = static_cast<TerrainCollision>(state.range(1));
  const auto points = static_cast<double>(state.range(0));
  const double before_MB = peak_MB();
  PartConfig part = bumps(0.1, collision, (points - 1) * 0.1);
  part.terrain->source = TerrainSource::sine;
  for (auto _ : state) benchmark::DoNotOptimize(std::make_unique<Ground>(part));
  state.counters["peak_MB"] = peak_MB() - before_MB;
  state.SetLabel(std::string(word_of(sim::terrain_collision_words, collision)));
}
BENCHMARK(build)->ArgsProduct({{512, 2001}, {0, 1, 2}})->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
