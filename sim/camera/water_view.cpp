// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_view.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "sim/random/random.hpp"

namespace sim {

namespace {

constexpr int grid_points = 128;
constexpr int lanes = 8;

/// Share of a wave that a grid shows: all of it from 8 points in a wave length on, nothing below 4.
double shown_share(double k_radpm, double spacing_m) {
  const double points = 2 * std::numbers::pi / (k_radpm * spacing_m);
  return std::clamp((points - 4) / 4, 0.0, 1.0);
}

}  // namespace

WaterView::WaterView(const Medium& medium, const LightConfig& light, const WaterLook& look)
    : medium_(medium),
      optics_(look.optics),
      sky_(light),
      day_(static_cast<float>(light.sky + std::max(0.0, light.to_sun_W().z()) * light.sun)),
      waves_range_m_(look.waves_range_m),
      has_caustics_(look.caustics && sky_.sun_is_up()),
      snow_(look.particles_per_m3, look.seed) {
  light_.attenuation = optics_.attenuation;
  light_.downward = optics_.downward;
  light_.at_surface = 0.25F * day_ * optics_.scattering;
  if (sky_.sun_is_up()) light_.sun = sky_.sun();
  light_.molecules = optics_.molecular;
  light_.particles = optics_.scattering - optics_.molecular;
  light_.wind_slope = static_cast<float>(0.003 + 0.00512 * medium.mean_wind_mps());
  if (has_caustics_) make_ripples(look.seed);
}

void WaterView::make_ripples(std::uint64_t seed) {
  // Sunlight under water, by Snell's law.
  const Eigen::Vector3f& sun = sky_.to_sun_W();
  const Eigen::Vector2f across = sun.head<2>() / static_cast<float>(water_index);
  sun_slant_ = across / std::sqrt(1 - across.squaredNorm());
  Random random(seed, "caustics");
  constexpr double longest_m = 2, shortest_m = 0.2;
  const auto count = static_cast<double>(ripples_.size());
  const double slope = std::sqrt(2 * static_cast<double>(light_.wind_slope) / count);
  for (std::size_t i = 0; i < ripples_.size(); ++i) {
    const double length_m = longest_m * std::pow(shortest_m / longest_m, static_cast<double>(i) / (count - 1));
    const double k_radpm = 2 * std::numbers::pi / length_m, direction_rad = 2 * std::numbers::pi * random.uniform();
    Ripple& ripple = ripples_[i];
    ripple.x_radpm = static_cast<float>(k_radpm * std::cos(direction_rad));
    ripple.y_radpm = static_cast<float>(k_radpm * std::sin(direction_rad));
    ripple.omega_radps = static_cast<float>(std::sqrt(9.81 * k_radpm));
    ripple.phase_rad = static_cast<float>(2 * std::numbers::pi * random.uniform());
    // Curvature of the surface times the share of its slope by which light is bent.
    ripple.focus_pm = static_cast<float>(slope * k_radpm * (1 - 1 / water_index));
  }
}

float WaterView::caustic(const Vector3d& p_W) const {
  const auto depth_m = static_cast<float>(level_m_ - p_W.z());
  if (depth_m <= 0) return 1;
  const float x_m = static_cast<float>(p_W.x()) + depth_m * sun_slant_.x();
  const float y_m = static_cast<float>(p_W.y()) + depth_m * sun_slant_.y();
  // The width of the sun and scattering smooth the light of short ripples.
  constexpr float smooth_per_m = 0.015F;
  float sum = 0, variance = 0;
  for (const Ripple& ripple : ripples_) {
    const float k_squared = ripple.x_radpm * ripple.x_radpm + ripple.y_radpm * ripple.y_radpm;
    const float width_m = smooth_per_m * depth_m, blurred = 1 + 0.5F * k_squared * width_m * width_m;
    const float focus = depth_m * ripple.focus_pm / (blurred * blurred);
    sum += focus * std::cos(ripple.x_radpm * x_m + ripple.y_radpm * y_m - ripple.now_rad);
    variance += 0.5F * focus * focus;
  }
  constexpr float max_variance = 0.5F;
  const float scale = std::sqrt(std::min(1.0F, max_variance / std::max(variance, 1e-9F)));
  return std::exp(scale * sum - 0.5F * scale * scale * variance);
}

void WaterView::draw_particles(const Pose& X_WS, const Optics& optics, double refraction,
                               std::span<const LampLight> lamps, const MarineSnow::Target& target) const {
  if (!is_under() || snow_.empty()) return;
  snow_.draw(X_WS, now_s_, optics, refraction, light_, day_ * daylight(X_WS.translation().z()), lamps, target);
}

void WaterView::update(const Vector3d& eye_W) {
  // Place of the camera.
  eye_W_ = eye_W;
  now_s_ = to_seconds(medium_.now());
  level_m_ = medium_.still_surface_m();
  highest_m_ = medium_.highest_surface_m() - level_m_;
  light_.is_under = medium_.in_water(eye_W);
  light_.eye_depth_m = static_cast<float>(level_m_ - eye_W.z());
  set_gain();
  for (Ripple& ripple : ripples_)
    ripple.now_rad = static_cast<float>(
        std::fmod(static_cast<double>(ripple.omega_radps) * now_s_, 2 * std::numbers::pi) - ripple.phase_rad);
  light_.at_eye = light_.at_surface.cwiseProduct(daylight(eye_W.z()));
  // Grids, each twice as wide as the one before.
  levels_.clear();
  if (!medium_.has_waves()) return;
  // From a depth at which nothing is left of the light of the surface its waves are not seen.
  constexpr float least_share = 1e-4F;
  const float over_m = light_.eye_depth_m - static_cast<float>(highest_m_);
  if (is_under() && std::exp(-light_.attenuation.minCoeff() * over_m) < least_share) return;
  double slopes = 0;
  for (const WaveComponent& wave : medium_.wave_components())
    slopes += std::pow(wave.amplitude_m * wave.k_radpm, 2) / 2;
  steep_ = 2 * std::sqrt(slopes);
  const double height_m = std::abs(eye_W.z() - level_m_);
  double spacing_m = std::clamp(0.02 * height_m, 0.06, 2.0);
  for (double half_m = 0; half_m < waves_range_m_; spacing_m *= 2) {
    half_m = 0.5 * grid_points * spacing_m;
    levels_.emplace_back().spacing_m = spacing_m;
    fill(levels_.back());
  }
}

void WaterView::set_gain() {
  gain_.setOnes();
  if (!is_under()) return;
  constexpr float subject_m = 3, max_ratio = 24;
  const float depth_m = std::max(0.0F, light_.eye_depth_m);
  const float min_downward = optics_.downward.minCoeff(), min_attenuation = optics_.attenuation.minCoeff();
  const float brightest = std::min(1.6F * std::exp(min_downward * depth_m), 1e4F);
  for (int i = 0; i < 3; ++i) {
    const float lost =
        (optics_.downward[i] - min_downward) * depth_m + (optics_.attenuation[i] - min_attenuation) * subject_m;
    gain_[i] = brightest * std::min(std::exp(lost), max_ratio);
  }
}

void WaterView::fill(Level& level) const {
  level.points.assign(std::size_t{grid_points} * grid_points, {});
  level.rough = 0;
  // Eight columns at a time.
  using Lanes = Eigen::Array<float, lanes, 1>;
  const Lanes column = Lanes::LinSpaced(0, lanes - 1);
  std::vector<Lanes> sums(3 * std::size_t{grid_points} * grid_points / lanes, Lanes::Zero());
  const double start_x_m = eye_W_.x() - 0.5 * grid_points * level.spacing_m;
  const double start_y_m = eye_W_.y() - 0.5 * grid_points * level.spacing_m;
  for (const WaveComponent& wave : medium_.wave_components()) {
    const double share = shown_share(wave.k_radpm, level.spacing_m);
    const double slope = wave.amplitude_m * wave.k_radpm;
    level.rough += static_cast<float>((1 - share * share) * slope * slope / 2);
    if (share == 0) continue;
    // The phase advances by the same angle from point to point: a rotation of (cos, sin).
    const double kx = wave.k_radpm * std::cos(wave.direction_rad), ky = wave.k_radpm * std::sin(wave.direction_rad);
    const auto turn_cos = static_cast<float>(std::cos(lanes * kx * level.spacing_m));
    const auto turn_sin = static_cast<float>(std::sin(lanes * kx * level.spacing_m));
    const Lanes ahead = static_cast<float>(kx * level.spacing_m) * column;
    const Lanes ahead_cos = ahead.cos(), ahead_sin = ahead.sin();
    const auto slope_x = static_cast<float>(-wave.amplitude_m * kx * share);
    const auto slope_y = static_cast<float>(-wave.amplitude_m * ky * share);
    const auto amplitude_m = static_cast<float>(wave.amplitude_m * share);
    Lanes* sum = sums.data();
    for (int row = 0; row < grid_points; ++row) {
      const double phase =
          kx * start_x_m + ky * (start_y_m + row * level.spacing_m) - wave.omega_radps * now_s_ + wave.phase_rad;
      const auto phase_cos = static_cast<float>(std::cos(phase)), phase_sin = static_cast<float>(std::sin(phase));
      Lanes cosine = phase_cos * ahead_cos - phase_sin * ahead_sin;
      Lanes sine = phase_sin * ahead_cos + phase_cos * ahead_sin;
      for (int i = 0; i < grid_points / lanes; ++i, sum += 3) {
        sum[0] += amplitude_m * cosine;
        sum[1] += slope_x * sine;
        sum[2] += slope_y * sine;
        const Lanes next = cosine * turn_cos - sine * turn_sin;
        sine = sine * turn_cos + cosine * turn_sin;
        cosine = next;
      }
    }
  }
  for (std::size_t i = 0; i < level.points.size(); ++i) {
    const Lanes* sum = sums.data() + 3 * (i / lanes);
    const auto lane = static_cast<Eigen::Index>(i % lanes);
    level.points[i] = {sum[0][lane], sum[1][lane], sum[2][lane]};
  }
}

WaterView::Cell WaterView::cell_of(const Level& level, double x_m, double y_m) const {
  const auto scale = static_cast<float>(1 / level.spacing_m);
  const float u = static_cast<float>(x_m - eye_W_.x()) * scale + 0.5F * grid_points;
  const float v = static_cast<float>(y_m - eye_W_.y()) * scale + 0.5F * grid_points;
  const int column = std::clamp(static_cast<int>(u), 0, grid_points - 2);
  const int row = std::clamp(static_cast<int>(v), 0, grid_points - 2);
  return {level.points.data() + row * grid_points + column, std::clamp(u - static_cast<float>(column), 0.0F, 1.0F),
          std::clamp(v - static_cast<float>(row), 0.0F, 1.0F)};
}

WaterView::Surface WaterView::sample(const Level& level, double x_m, double y_m) const {
  const Cell cell = cell_of(level, x_m, y_m);
  const auto between = [&](float Point::*member) {
    const Point* at = cell.corner;
    const float low = at[0].*member + cell.right * (at[1].*member - at[0].*member);
    at += grid_points;
    const float high = at[0].*member + cell.right * (at[1].*member - at[0].*member);
    return low + cell.up * (high - low);
  };
  return {between(&Point::elevation_m), between(&Point::slope_x), between(&Point::slope_y), level.rough};
}

WaterView::Place WaterView::place_of(const Vector3d& p_W) const {
  // The finest grid that holds the place, by the exponent of a float.
  const auto away_m = static_cast<float>(std::max(std::abs(p_W.x() - eye_W_.x()), std::abs(p_W.y() - eye_W_.y())));
  const float ratio = away_m / static_cast<float>(0.48 * grid_points * levels_.front().spacing_m);
  if (ratio < 1) return {0, ratio};
  const auto bits = std::bit_cast<std::uint32_t>(ratio);
  return {(bits >> 23) - 126, static_cast<float>(bits & 0x7FFFFF) / 0x800000};
}

float WaterView::elevation_m(const Vector3d& p_W) const {
  const std::size_t number = place_of(p_W).level;
  if (number + 1 >= levels_.size()) return 0;
  const Cell cell = cell_of(levels_[number], p_W.x(), p_W.y());
  const Point* at = cell.corner;
  const float low = at[0].elevation_m + cell.right * (at[1].elevation_m - at[0].elevation_m);
  at += grid_points;
  const float high = at[0].elevation_m + cell.right * (at[1].elevation_m - at[0].elevation_m);
  return low + cell.up * (high - low);
}

WaterView::Surface WaterView::surface_at(const Vector3d& p_W) const {
  if (levels_.empty()) return {};
  const auto [number, share] = place_of(p_W);
  // Beyond the largest level single waves are below a pixel: only their mean roughness is seen.
  if (number + 1 >= levels_.size()) return {0, 0, 0, levels_.back().rough};
  const Surface near = sample(levels_[number], p_W.x(), p_W.y());
  // The blend from one level to the next avoids a visible seam between them.
  if (share < 0.5F) return near;
  const Surface far = sample(levels_[number + 1], p_W.x(), p_W.y());
  const float blend = 2 * share - 1;
  return {near.elevation_m + blend * (far.elevation_m - near.elevation_m),
          near.slope_x + blend * (far.slope_x - near.slope_x), near.slope_y + blend * (far.slope_y - near.slope_y),
          near.rough + blend * (far.rough - near.rough)};
}

double WaterView::crossing_m(const Vector3d& direction_W, double range_max_m) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (levels_.empty()) {
    const double range_m = (level_m_ - eye_W_.z()) / direction_W.z();
    return range_m > 0 && range_m < range_max_m ? range_m : none;
  }
  return wave_crossing_m(direction_W, range_max_m);
}

double WaterView::wave_crossing_m(const Vector3d& direction_W, double range_max_m) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  // Interval in which the ray is between the highest crest and the deepest trough.
  const double z_m = eye_W_.z() - level_m_, down = direction_W.z();
  double from_m = 0, to_m = std::min(range_max_m, 4 * waves_range_m_);
  if (std::abs(down) > 1e-9) {
    const double a_m = (highest_m_ - z_m) / down, b_m = (-highest_m_ - z_m) / down;
    from_m = std::max(0.0, std::min(a_m, b_m));
    to_m = std::min(range_max_m, std::max(a_m, b_m));
  } else if (std::abs(z_m) > highest_m_) {
    return none;
  }
  if (from_m >= to_m) return none;
  // Approach the surface by steps that cannot cross waves of a usual slope, until it is nearer than a pixel is wide, or
  // crossed after all.
  const double side = is_under() ? -1 : 1;
  const auto height_over_m = [&](double range_m) {
    const Vector3d p_W = eye_W_ + range_m * direction_W;
    return side * (p_W.z() - level_m_ - static_cast<double>(elevation_m(p_W)));
  };
  const double closing = std::abs(down) + steep_ * std::sqrt(std::max(0.0, 1 - down * down));
  double last_m = from_m, last_height_m = height_over_m(from_m);
  if (last_height_m < 0) return from_m > 0 ? from_m : none;
  for (int i = 0; i < 48 && last_m < to_m; ++i) {
    if (last_height_m < 0.001 * last_m) return last_m + last_height_m / closing;
    const double next_m = std::min(to_m, last_m + std::max(last_height_m / closing, 0.004 * last_m + 0.005));
    const double height_m = height_over_m(next_m);
    if (height_m < 0) return last_m + last_height_m / (last_height_m - height_m) * (next_m - last_m);
    last_m = next_m, last_height_m = height_m;
  }
  const double flat_m = -z_m / down;
  return flat_m > 0 && flat_m < range_max_m ? flat_m : none;
}

LinearColor WaterView::daylight(double z_m) const {
  return daylight_at(light_, static_cast<float>(level_m_ - z_m));
}

void WaterView::find_surface(std::span<const Ray> rays, WaterRays& lit) const {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    for (int axis = 0; axis < 3; ++axis) lit.direction_W[axis][i] = static_cast<float>(ray.direction_W[axis]);
    const double range_max_m = std::min(ray.range_max_m, static_cast<double>(lit.range_m[i]));
    const double range_m = crossing_m(ray.direction_W, range_max_m);
    lit.crossing_m[i] = static_cast<float>(range_m);
    if (levels_.empty() || !(range_m < range_max_m)) continue;
    const Surface surface = surface_at(eye_W_ + range_m * ray.direction_W);
    lit.slope_x[i] = surface.slope_x;
    lit.slope_y[i] = surface.slope_y;
    lit.rough[i] = surface.rough;
  }
}

}  // namespace sim
