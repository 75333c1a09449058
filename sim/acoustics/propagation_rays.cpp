// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/acoustics/propagation.hpp"
#include "sim/acoustics/rays/ray_tables.hpp"
#include "sim/acoustics/sound_path.hpp"

// Propagation along rays, and the echoes on which a receiver may lock.

namespace sim {

namespace {

/// Upper limit of the gain by focusing, which is infinite at a caustic.
constexpr double most_focus_dB = Propagation::most_focus_dB;

/// Unit vector with this elevation, in the vertical plane through two points.
Vector3d ray_direction_W(const Vector3d& from_W, const Vector3d& to_W, double elevation_rad) {
  const Vector3d level_W((to_W - from_W).x(), (to_W - from_W).y(), 0);
  const double level_m = level_W.norm();
  const Vector3d along_W = level_m > 1e-9 ? Vector3d(level_W / level_m) : Vector3d(Vector3d::UnitX());
  return along_W * std::cos(elevation_rad) + Vector3d::UnitZ() * std::sin(elevation_rad);
}

}  // namespace

std::vector<SoundRay> Propagation::rays_between(const Vector3d& from_W, const Vector3d& to_W, int max_bounces) const {
  const double still_m = medium_.still_surface_m();
  const Vector3d middle_W = (from_W + to_W) / 2;
  RayQuery query;
  query.source_m = still_m - from_W.z();
  query.receiver_m = still_m - to_W.z();
  query.range_m = (to_W - from_W).head<2>().norm();
  query.water_m = water_depth_m(middle_W);
  // The depth of a bottom found below the waves, below the still surface.
  const bool given = config_.multipath && config_.multipath->water_depth_m;
  if (!given) query.water_m += still_m - medium_.surface_m(middle_W.x(), middle_W.y());
  // A transducer that lies on the bottom is in the water.
  query.water_m = std::max({query.water_m, query.source_m, query.receiver_m, 0.0});
  query.max_bounces = max_bounces;
  std::vector<SoundRay> rays;
  rays_->of(query.water_m).find(query, rays);
  return rays;
}

Propagation::First Propagation::first_of(const std::vector<SoundRay>& rays, const Vector3d& from_W,
                                         const Vector3d& to_W) const {
  const auto direct = std::find_if(rays.begin(), rays.end(), [](const SoundRay& ray) { return ray.bounces() == 0; });
  First first;
  first.shadow = direct == rays.end();
  if (first.shadow && (rays.empty() || config_.shadow_loss_dB)) {
    // The straight line: of sound that leaks into the shadow, and of silence.
    const Vector3d displacement_W = to_W - from_W;
    const double range_m = displacement_W.norm();
    first.travel_time_s = sim::travel_time_s(medium_, from_W, to_W);
    if (range_m > 0) first.leaves_W = first.arrives_W = displacement_W / range_m;
    return first;
  }
  const SoundRay& ray = first.shadow ? rays.front() : *direct;
  first.travel_time_s = ray.travel_time_s;
  first.leaves_W = ray_direction_W(from_W, to_W, ray.launch_rad);
  first.arrives_W = ray_direction_W(from_W, to_W, ray.arrival_rad);
  return first;
}

Propagation::First Propagation::first_arrival(const Vector3d& from_W, const Vector3d& to_W) const {
  // Bounces matter only where no other ray arrives.
  const First first = first_of(rays_between(from_W, to_W, 0), from_W, to_W);
  if (!first.shadow || !config_.multipath) return first;
  return first_of(rays_between(from_W, to_W, config_.multipath->max_bounces), from_W, to_W);
}

Propagation::Gain Propagation::gain_of_rays(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz,
                                            Decibels direct, Random& random) const {
  const MultipathConfig* const multipath = config_.multipath ? &*config_.multipath : nullptr;
  std::vector<SoundRay> rays = rays_between(from_W, to_W, multipath != nullptr ? multipath->max_bounces : 0);
  Gain gain;
  gain.first = first_of(rays, from_W, to_W);
  const double first_s = gain.first->travel_time_s;
  const bool blocked = std::isinf(direct.dB());
  if (blocked) std::erase_if(rays, [](const SoundRay& ray) { return ray.bounces() == 0; });
  // Loss and phase of each ray.
  const MultipathMedium water = water_between(from_W, to_W, frequency_Hz);
  const double k = 2 * std::numbers::pi * frequency_Hz / water.sound_speed_mps;
  const double roughness_m = multipath == nullptr ? 0
                                                  : multipath->surface_roughness_m.value_or(
                                                        wind_sea_roughness_m(water.wind_mps));
  std::vector<PathGain> paths;
  std::vector<Vector3d> arrive_W;
  for (const SoundRay& ray : rays) {
    PathGain path;
    const double length_m = std::max(ray.travel_time_s * water.sound_speed_mps, 1.0);
    const double focus_dB = 10 * std::log10(std::max(ray.power_per_m2 * length_m * length_m, 1e-30));
    path.delay_s = ray.travel_time_s;
    path.gain = Decibels(std::min(focus_dB, most_focus_dB)) - spreading_loss(length_m, config_.spreading) -
                absorption_loss(length_m, water.absorption_dBpkm);
    path.phase_rad = std::fmod(2 * std::numbers::pi * frequency_Hz * ray.travel_time_s, 2 * std::numbers::pi) -
                     ray.caustics * std::numbers::pi / 2;
    if (ray.bounces() == 0) path.gain += direct;
    if (ray.surface_bounces > 0) {
      path.gain += ray.surface_bounces *
                   (multipath->surface_loss_dB
                        ? Decibels(-*multipath->surface_loss_dB)
                        : pressure_level(surface_reflection(k, roughness_m, ray.surface_grazing_rad)));
      path.phase_rad += ray.surface_bounces * std::numbers::pi;
    }
    if (ray.bottom_bounces > 0) {
      const std::complex<double> bottom = bottom_reflection(multipath->bottom, ray.bottom_grazing_rad);
      path.gain += ray.bottom_bounces * pressure_level(std::abs(bottom));
      path.phase_rad += ray.bottom_bounces * std::arg(bottom);
    }
    paths.push_back(path);
    arrive_W.push_back(ray_direction_W(from_W, to_W, ray.arrival_rad));
  }
  // Sound that leaks into the shadow.
  if (gain.first->shadow && config_.shadow_loss_dB && !blocked) {
    PathGain leak;
    leak.delay_s = sim::travel_time_s(medium_, from_W, to_W);
    leak.gain = direct - transmission_loss(from_W, to_W, frequency_Hz) - Decibels(*config_.shadow_loss_dB);
    paths.insert(paths.begin(), leak);
    arrive_W.insert(arrive_W.begin(), gain.first->arrives_W);
  }
  if (paths.empty()) {
    gain.signal = to_decibels(PowerRatio{});
    return gain;
  }
  if (multipath != nullptr && multipath->phases == MultipathConfig::Phases::random) randomize_phases(paths, random);
  // The direct path is blocked: the first echo is the first arrival.
  if (blocked) {
    gain.later_s = std::max(0.0, paths.front().delay_s - first_s);
    gain.first->arrives_W = arrive_W.front();
  }
  // Echoes that a receiver may take for the first arrival.
  const double begins_s = blocked ? paths.front().delay_s : first_s;
  const double window_s = multipath != nullptr ? multipath->window_s : std::numeric_limits<double>::infinity();
  if (config_.echo_lock && !blocked) {
    double first_dB = -std::numeric_limits<double>::infinity();
    for (const PathGain& path : paths)
      if (path.delay_s == begins_s) first_dB = std::max(first_dB, path.gain.dB());
    for (std::size_t i = 0; i < paths.size(); ++i)
      if (paths[i].delay_s > begins_s && paths[i].delay_s - begins_s <= window_s)
        gain.echoes.push_back({paths[i].delay_s - begins_s, to_power(paths[i].gain - Decibels(first_dB)), arrive_W[i]});
  }
  // Sound before the first arrival, by bounces through faster water, belongs to the signal too.
  for (PathGain& path : paths) path.delay_s = std::max(path.delay_s, begins_s);
  const MultipathSum sum = combine(paths, window_s);
  gain.signal = to_decibels(sum.signal);
  gain.disturbing = sum.interference;
  return gain;
}

std::vector<Propagation::Gain::Echo> Propagation::straight_echoes(const Vector3d& from_W, const Vector3d& to_W,
                                                                  double frequency_Hz) const {
  const LinkDepths depths = link_depths(from_W, to_W);
  const double water_m = std::max(0.0, depths.water_m);
  std::vector<ImagePath> images;
  image_paths(std::clamp(depths.source_m, 0.0, water_m), std::clamp(depths.receiver_m, 0.0, water_m),
              depths.horizontal_m, water_m, config_.multipath->max_bounces, images);
  std::vector<PathGain> gains;
  path_gains(images, *config_.multipath, water_between(from_W, to_W, frequency_Hz), gains);
  std::vector<Gain::Echo> echoes;
  for (std::size_t i = 1; i < gains.size(); ++i) {
    const double later_s = gains[i].delay_s - gains[0].delay_s;
    if (later_s > config_.multipath->window_s) continue;
    // A path arrives upwards when it leaves so and is reversed an even number of times, and vice versa.
    const bool even = (images[i].surface_bounces + images[i].bottom_bounces) % 2 == 0;
    const double elevation_rad = images[i].leaves_upwards == even ? images[i].grazing_rad : -images[i].grazing_rad;
    echoes.push_back(
        {later_s, to_power(gains[i].gain - gains[0].gain), ray_direction_W(from_W, to_W, elevation_rad)});
  }
  return echoes;
}

}  // namespace sim
