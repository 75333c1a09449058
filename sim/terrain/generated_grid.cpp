// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/config/message_text.hpp"
#include "sim/random/random.hpp"
#include "sim/terrain/terrain.hpp"

namespace sim {
namespace {

/// Gradient noise (Perlin, Improving Noise, SIGGRAPH 2002) on a lattice of spacing 1, with period 256: smooth,
/// and 0 at the points of the lattice.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t seed) {
    Random random(seed, "terrain");
    random.begin_step(0);
    for (std::size_t i = 0; i < 256; ++i) order_[i] = static_cast<std::uint8_t>(i);
    for (std::uint32_t i = 255; i > 0; --i) std::swap(order_[i], order_[random.integer_below(i + 1)]);
  }
  double at(double x, double y) const {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
    const double u = x - fx, v = y - fy, s = fade(u), t = fade(v);
    const double south = blend(s, corner(i, j, u, v), corner(i + 1, j, u - 1, v));
    const double north = blend(s, corner(i, j + 1, u, v - 1), corner(i + 1, j + 1, u - 1, v - 1));
    return blend(t, south, north);
  }

 private:
  static double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }
  static double blend(double t, double a, double b) { return a + t * (b - a); }
  /// Returns the product of the gradient at a lattice point, one of eight, and the offset (u, v) from the point.
  double corner(std::int64_t i, std::int64_t j, double u, double v) const {
    constexpr double diagonal = std::numbers::sqrt2 / 2;
    const std::uint8_t first = order_[static_cast<std::size_t>(i & 255)];
    switch (order_[(first + static_cast<std::size_t>(j & 255)) & 255] & 7) {
      case 0:
        return u;
      case 1:
        return -u;
      case 2:
        return v;
      case 3:
        return -v;
      case 4:
        return diagonal * (u + v);
      case 5:
        return diagonal * (u - v);
      case 6:
        return diagonal * (v - u);
      default:
        return -diagonal * (u + v);
    }
  }
  std::array<std::uint8_t, 256> order_;
};

/// Sum of octaves of noise, each with half the wavelength of the previous one, down to four cells.  Octaves with
/// wavelengths over 8 times the size of the grid are omitted, because they are planes there.
void make_fractal(HeightGrid& grid, const TerrainConfig& config) {
  const GradientNoise noise(static_cast<std::uint64_t>(config.seed));
  double max_m = config.wavelength_m, weight = 1;
  while (max_m > 8 * std::max(grid.width_m(), grid.depth_m())) max_m /= 2;
  for (double wave_m = max_m; wave_m >= 4 * config.cell_m && weight > 1e-4; wave_m /= 2) {
    // Shift octaves by an irrational share of the wavelength, so that their zeros do not coincide.
    const double shift = std::numbers::phi * wave_m;
    for (int j = 0; j < grid.rows; ++j)
      for (int i = 0; i < grid.columns; ++i)
        grid.at(i, j) += weight * noise.at((grid.west_m + i * grid.cell_m + shift) / wave_m,
                                           (grid.south_m + j * grid.cell_m - shift) / wave_m);
    weight *= config.roughness;
  }
  // Scale to the desired amplitude.
  const double low = grid.lowest_m(), high = grid.highest_m();
  if (!(high > low)) return;
  for (double& height_m : grid.heights_m) height_m = config.amplitude_m * (2 * (height_m - low) / (high - low) - 1);
}

/// Fills the grid with heights that depend only on the distance along a direction.
template <typename HeightAlong>
void fill_along(HeightGrid& grid, double direction_rad, const HeightAlong& height_m) {
  const double toward_x = std::cos(direction_rad), toward_y = std::sin(direction_rad);
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i)
      grid.at(i, j) =
          height_m(toward_x * (grid.west_m + i * grid.cell_m) + toward_y * (grid.south_m + j * grid.cell_m));
}

}  // namespace

HeightGrid generate_grid(const TerrainConfig& config) {
  // Flat grid centered on the origin.
  const double columns = std::round(config.size_m[0] / config.cell_m) + 1;
  const double rows = std::round(config.size_m[1] / config.cell_m) + 1;
  check_grid_size(static_cast<std::int64_t>(std::min(columns, 1e12)), static_cast<std::int64_t>(std::min(rows, 1e12)));
  HeightGrid grid;
  grid.columns = static_cast<int>(columns);
  grid.rows = static_cast<int>(rows);
  grid.cell_m = config.cell_m;
  grid.west_m = -grid.width_m() / 2;
  grid.south_m = -grid.depth_m() / 2;
  grid.heights_m.assign(static_cast<std::size_t>(grid.columns) * grid.rows, 0);
  // Fill in the heights.
  switch (config.source) {
    case TerrainConfig::Source::slope: {
      const double climb = std::tan(config.angle_rad);
      fill_along(grid, config.direction_rad, [&](double along_m) { return climb * along_m; });
      break;
    }
    case TerrainConfig::Source::sine: {
      const double wave_number = 2 * std::numbers::pi / config.wavelength_m;
      fill_along(grid, config.direction_rad,
                 [&](double along_m) { return config.amplitude_m * std::sin(wave_number * along_m); });
      break;
    }
    case TerrainConfig::Source::fractal:
      make_fractal(grid, config);
      break;
    case TerrainConfig::Source::ascii:
    case TerrainConfig::Source::png:
      break;  // flat: their heights are in a file
  }
  return grid;
}

}  // namespace sim
