// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>

#include "sim/base/crc32.hpp"
#include "sim/terrain/height_grid.hpp"
#include "sim/terrain/terrain.hpp"

namespace {

using sim::HeightGrid;

TEST(Terrain, FractalDependsOnItsSeedAloneAndSpansTwiceItsAmplitude) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::fractal;
  config.size_m = {40, 20};
  config.amplitude_m = 3;
  const auto heights = [&] { return sim::load_terrain(config).grid.heights_m; };
  const std::vector<double> first = heights();
  EXPECT_EQ(first.size(), 41u * 21u);
  EXPECT_EQ(first, heights());
  EXPECT_NEAR(*std::max_element(first.begin(), first.end()), 3, 1e-12);
  EXPECT_NEAR(*std::min_element(first.begin(), first.end()), -3, 1e-12);
  config.seed = 2;
  EXPECT_NE(first, heights());
}

TEST(FractalTerrain, OfWavesFarLongerThanItselfIsAsOfThoseAFewTimesAsLong) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::fractal;
  config.size_m = {64, 32};
  config.wavelength_m = 512;  // 8 times as long
  config.roughness = 1;
  const sim::HeightGrid few_times = sim::generate_grid(config);
  config.wavelength_m = 512 * 16384;
  EXPECT_EQ(sim::generate_grid(config).heights_m, few_times.heights_m);
  config.wavelength_m = 256;
  EXPECT_NE(sim::generate_grid(config).heights_m, few_times.heights_m);
}

}  // namespace
