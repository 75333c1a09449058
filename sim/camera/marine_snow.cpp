// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/marine_snow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace sim {

namespace {

constexpr double cell_size_m = 0.5;
constexpr double reach_of_sight_m = 2.5;  ///< beyond it particles are too small to be seen
constexpr double near_m = 0.05;
constexpr double sinking_mps = 74.0 / 86'400;
constexpr double min_radius_m = 0.25e-3, max_radius_m = 1e-3;
constexpr float particle_albedo = 0.3F;
constexpr double max_radius_px = 16;

/// The generator splitmix64 (Steele et al. 2014).
struct Numbers {
  std::uint64_t state;
  std::uint64_t next() {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  /// Returns a number from 0 to 1.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
};

Numbers numbers_of(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t z) {
  Numbers numbers{seed};
  for (const std::int64_t value : {x, y, z}) numbers.state = numbers.next() ^ static_cast<std::uint64_t>(value);
  return numbers;
}

/// Turns a direction in the water into the one behind a flat port; nothing for one that no ray behind it has.
std::optional<Vector3d> behind_port(const Vector3d& p_S, double refraction) {
  if (refraction == 1) return p_S;
  const double across = std::hypot(p_S.y(), p_S.z()), length = p_S.norm();
  const double sine = refraction * across / length;
  if (p_S.x() <= 0 || sine >= 1) return std::nullopt;
  if (across == 0) return p_S;
  const double scale = length * sine / across;
  return Vector3d(length * std::sqrt(1 - sine * sine), scale * p_S.y(), scale * p_S.z());
}

/// Light of a particle, and where it is in the image.
struct Seen {
  Vector2d at_px;
  double radius_px;
  float depth_m;
  LinearColor light;
};

void draw_disc(const Seen& seen, const MarineSnow::Target& target) {
  // A particle that is smaller than a pixel dims with its area.
  const double drawn_px = std::clamp(seen.radius_px, 0.7, max_radius_px);
  const double strength = std::min(1.0, std::pow(seen.radius_px / drawn_px, 2));
  const int left = std::max(0, static_cast<int>(std::floor(seen.at_px.x() - drawn_px - 0.5)));
  const int right = std::min(target.light.width - 1, static_cast<int>(std::ceil(seen.at_px.x() + drawn_px)));
  const int top = std::max(target.first, static_cast<int>(std::floor(seen.at_px.y() - drawn_px - 0.5)));
  const int bottom = std::min(target.end - 1, static_cast<int>(std::ceil(seen.at_px.y() + drawn_px)));
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      if (*target.depth_m.at(column, row) < seen.depth_m) continue;
      const double off_px = std::hypot(column + 0.5 - seen.at_px.x(), row + 0.5 - seen.at_px.y());
      const double cover = strength * std::clamp(drawn_px + 0.5 - off_px, 0.0, 1.0);
      if (cover <= 0) continue;
      // Its light is added to what is behind it, which it hides only in part.
      float* rgb = target.light.at(column, row);
      for (int i = 0; i < 3; ++i) rgb[i] += target.weight * static_cast<float>(cover) * seen.light[i];
    }
}

}  // namespace

void MarineSnow::draw(const Pose& X_WS, double time_s, const Optics& optics, double refraction, const WaterLight& water,
                      const LinearColor& daylight, std::span<const LampLight> lamps, const Target& target) const {
  const Vector3d eye_W = X_WS.translation();
  const Matrix3d R_SW = X_WS.linear().transpose();
  const double sunk_m = sinking_mps * time_s;
  const Vector3d eye_grid = eye_W + Vector3d(0, 0, sunk_m);
  const auto low = ((eye_grid.array() - reach_of_sight_m) / cell_size_m).floor().cast<std::int64_t>().eval();
  const auto high = ((eye_grid.array() + reach_of_sight_m) / cell_size_m).floor().cast<std::int64_t>().eval();
  const double reach_m = 0.5 * std::sqrt(3.0) * cell_size_m;  // from the middle of a cell to its corners
  const double focal_px = optics.focal_x_px() * refraction;
  for (std::int64_t x = low[0]; x <= high[0]; ++x)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t z = low[2]; z <= high[2]; ++z) {
        const Vector3d corner =
            cell_size_m * Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        // Leave out cells out of sight.
        const Vector3d middle_S = R_SW * (corner + Vector3d::Constant(0.5 * cell_size_m) - eye_grid);
        const double away_m = middle_S.norm();
        if (away_m > reach_of_sight_m + reach_m) continue;
        if (away_m > 2 * reach_m) {
          const auto behind_S = behind_port(middle_S, refraction);
          // A cell may reach into the cone behind a port although its middle is outside.
          if (!behind_S && middle_S.x() < -reach_m) continue;
          const auto at_px = behind_S ? optics.project(*behind_S) : Vector2d(0.5 * optics.width(), target.first);
          const double wide_px = 2 * reach_m / (away_m - reach_m) * focal_px + 2 * max_radius_px;
          if (!at_px || at_px->x() < -wide_px || at_px->x() > optics.width() + wide_px ||
              at_px->y() < target.first - wide_px || at_px->y() > target.end + wide_px)
            continue;
        }
        Numbers numbers = numbers_of(seed_, x, y, z);
        const double count = per_m3_ * cell_size_m * cell_size_m * cell_size_m + numbers.uniform();
        for (int i = 1; i <= static_cast<int>(count); ++i) {
          const double u = numbers.uniform(), v = numbers.uniform(), w = numbers.uniform(), size = numbers.uniform();
          const Vector3d p_W = corner + cell_size_m * Vector3d(u, v, w) - eye_grid;  // relative to the camera
          const Vector3d p_S = R_SW * p_W;
          const double distance_m = p_S.norm();
          if (distance_m < near_m || distance_m > reach_of_sight_m || p_S.x() < target.port_m) continue;
          const auto behind_S = behind_port(p_S, refraction);
          const auto at_px = behind_S ? optics.project(*behind_S) : std::nullopt;
          if (!at_px || at_px->y() < target.first - max_radius_px || at_px->y() > target.end + max_radius_px ||
              at_px->x() < -max_radius_px || at_px->x() > optics.width() + max_radius_px)
            continue;
          if (water.eye_depth_m < p_W.z()) continue;  // above the surface
          // Small ones are more: radii with a density that falls with the third power.
          const double span = std::pow(min_radius_m / max_radius_m, 2);
          const double radius_m = min_radius_m / std::sqrt(1 - size * (1 - span));
          Seen seen;
          seen.at_px = *at_px;
          seen.radius_px = radius_m / distance_m * focal_px;
          seen.depth_m = static_cast<float>(target.depth_along_ray ? distance_m : p_S.x());
          // They fade out towards the end of the range.
          const auto fading = static_cast<float>(std::min(1.0, 4 * (1 - distance_m / reach_of_sight_m)));
          seen.light = particle_albedo * daylight;
          for (const LampLight& lamp : lamps)
            seen.light += particle_albedo * lamp_light_at(water, lamp, p_W.cast<float>());
          seen.light.array() *= fading * (-static_cast<float>(distance_m) * water.attenuation).array().exp();
          draw_disc(seen, target);
        }
      }
}

}  // namespace sim
