// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/acoustics/propagation/sound_path.hpp"
#include "sim/acoustics/rays/caustic.hpp"
#include "sim/acoustics/rays/ray_tables.hpp"

// Propagation along rays, and the echoes on which a receiver may lock.

namespace sim {

namespace {

/// Most power of a ray without a twin over that of a straight path of its length: 30 dB.  Caustics at which more than
/// two rays merge have no finite power by ray tubes.
constexpr double max_unpaired_focus = 1000;

/// Phase between twins at which their tubes and the fold between them count equally.
constexpr double near_caustic_rad = 6;

double square_of(double x) {
  return x * x;
}

/// Unit vector with this elevation, in the vertical plane through two points.
Vector3d ray_direction_W(const Vector3d& from_W, const Vector3d& to_W, double elevation_rad) {
  const Vector3d level_W((to_W - from_W).x(), (to_W - from_W).y(), 0);
  const double level_m = level_W.norm();
  const Vector3d along_W = level_m > 1e-9 ? Vector3d(level_W / level_m) : Vector3d(Vector3d::UnitX());
  return along_W * std::cos(elevation_rad) + Vector3d::UnitZ() * std::sin(elevation_rad);
}

}  // namespace

std::vector<PathGain> ray_gains(std::span<const SoundRay> rays, const MultipathConfig* multipath,
                                const MultipathMedium& water) {
  constexpr double pi = std::numbers::pi;
  const double k = 2 * pi * water.frequency_Hz / water.sound_speed_mps;
  const double roughness_m =
      multipath == nullptr ? 0 : multipath->surface_roughness_m.value_or(wind_sea_roughness_m(water.wind_mps));
  std::vector<PathGain> paths;
  for (const SoundRay& ray : rays) {
    PathGain path;
    const double length_m = std::max(ray.travel_time_s * water.sound_speed_mps, 1.0);
    double power = ray.power_per_m2;
    path.delay_s = ray.travel_time_s;
    path.phase_rad = std::fmod(2 * pi * water.frequency_Hz * ray.travel_time_s, 2 * pi) - ray.caustics * pi / 2;
    if (ray.twin) {
      const double apart_rad = 2 * pi * water.frequency_Hz * std::abs(ray.twin->later_s);
      const CausticChange change = caustic_change(apart_rad);
      // Near the caustic the power of the tube has the errors of a small slope between layers.
      const double near = 1 / (1 + square_of(apart_rad / near_caustic_rad));
      power = change.power * std::pow(power, 1 - near) * std::pow(ray.twin->fold_power_per_m2, near);
      path.phase_rad += ray.twin->later_s < 0 ? change.later_rad : -change.later_rad;
    } else {
      power = std::min(power, max_unpaired_focus / (length_m * length_m));
    }
    path.gain = to_decibels(PowerRatio(std::min(power, 1.0))) - absorption_loss(length_m, water.absorption_dBpkm);
    if (ray.surface_bounces > 0) {
      path.gain +=
          ray.surface_bounces * (multipath->surface_loss_dB
                                     ? Decibels(-*multipath->surface_loss_dB)
                                     : pressure_level(surface_reflection(k, roughness_m, ray.surface_grazing_rad)));
      path.phase_rad += ray.surface_bounces * pi;
    }
    if (ray.bottom_bounces > 0) {
      const std::complex<double> bottom = bottom_reflection(multipath->bottom, ray.bottom_grazing_rad);
      path.gain += ray.bottom_bounces * pressure_level(std::abs(bottom));
      path.phase_rad += ray.bottom_bounces * std::arg(bottom);
    }
    paths.push_back(path);
  }
  return paths;
}

struct Propagation::Arrivals {
  struct Way {
    double launch_rad, arrival_rad;
    bool bounces;
  };
  std::vector<PathGain> paths;
  std::vector<Way> ways;  // of the same paths
  bool shadow = true;

  First arrival(std::size_t path, const Vector3d& from_W, const Vector3d& to_W) const {
    return {paths[path].delay_s, ray_direction_W(from_W, to_W, ways[path].launch_rad),
            ray_direction_W(from_W, to_W, ways[path].arrival_rad), shadow};
  }
};

std::size_t first_path(std::span<const PathGain> paths) {
  Decibels strongest = paths.front().gain;
  for (const PathGain& path : paths) strongest = std::max(strongest, path.gain);
  std::size_t first = paths.size();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool strong = paths[i].gain >= strongest - Decibels(first_path_dB);
    if (strong && (first == paths.size() || paths[i].delay_s < paths[first].delay_s)) first = i;
  }
  return first;
}

std::vector<SoundRay> Propagation::rays_between(const Vector3d& from_W, const Vector3d& to_W) const {
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
  query.max_bounces = config_.multipath ? config_.multipath->max_bounces : 0;
  std::vector<SoundRay> rays;
  rays_->of(query.water_m).find(query, rays);
  return rays;
}

/// Whether a ray misses an end by less than half of sqrt(wavelength x range), the width of the zone in which a wave is
/// not yet dark (the first Fresnel zone half-way is as wide).
bool Propagation::is_at_edge_of_shadow(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const {
  const double wavelength_m = medium_.sound_speed_mps(to_W) / frequency_Hz;
  const double near_m = 0.5 * std::sqrt(wavelength_m * (to_W - from_W).norm());
  const double surface_m = medium_.still_surface_m();
  const auto arrives_without_bounce = [&](Vector3d source_W, Vector3d receiver_W) {
    source_W.z() = std::min(source_W.z(), surface_m);
    receiver_W.z() = std::min(receiver_W.z(), surface_m);
    const std::vector<SoundRay> rays = rays_between(source_W, receiver_W);
    return std::any_of(rays.begin(), rays.end(), [](const SoundRay& ray) { return ray.bounces() == 0; });
  };
  const Vector3d up_W = near_m * Vector3d::UnitZ();
  return arrives_without_bounce(from_W, to_W + up_W) || arrives_without_bounce(from_W, to_W - up_W) ||
         arrives_without_bounce(from_W + up_W, to_W) || arrives_without_bounce(from_W - up_W, to_W);
}

Propagation::Arrivals Propagation::arrivals(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const {
  Arrivals arrivals;
  const std::vector<SoundRay> rays = rays_between(from_W, to_W);
  arrivals.paths =
      ray_gains(rays, config_.multipath ? &*config_.multipath : nullptr, water_between(from_W, to_W, frequency_Hz));
  for (const SoundRay& ray : rays) {
    arrivals.ways.push_back({ray.launch_rad, ray.arrival_rad, ray.bounces() > 0});
    arrivals.shadow = arrivals.shadow && ray.bounces() > 0;
  }
  // Sound that leaks into the shadow, along the straight line.
  std::optional<double> loss_dB;
  if (arrivals.shadow) {
    loss_dB = config_.shadow_loss_dB;
    if (is_at_edge_of_shadow(from_W, to_W, frequency_Hz)) {
      constexpr double knife_edge_dB = 6;
      loss_dB = std::min(knife_edge_dB, loss_dB.value_or(knife_edge_dB));
      arrivals.shadow = false;
    }
  }
  if (loss_dB) {
    PathGain leak;
    leak.delay_s = sim::travel_time_s(medium_, from_W, to_W);
    leak.gain = -transmission_loss(from_W, to_W, frequency_Hz) - Decibels(*loss_dB);
    const Vector3d displacement_W = to_W - from_W;
    const double elevation_rad = std::atan2(displacement_W.z(), displacement_W.head<2>().norm());
    arrivals.paths.push_back(leak);
    arrivals.ways.push_back({elevation_rad, elevation_rad, false});
  }
  return arrivals;
}

Propagation::First Propagation::first_arrival(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const {
  const Arrivals found = arrivals(from_W, to_W, frequency_Hz);
  if (!found.paths.empty()) return found.arrival(first_path(found.paths), from_W, to_W);
  // Silence, at the time of the straight line.
  First first;
  const Vector3d displacement_W = to_W - from_W;
  const double range_m = displacement_W.norm();
  first.travel_time_s = sim::travel_time_s(medium_, from_W, to_W);
  if (range_m > 0) first.leaves_W = first.arrives_W = displacement_W / range_m;
  first.shadow = true;
  return first;
}

Propagation::Gain Propagation::gain_of_rays(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz,
                                            Decibels direct, Random& random) const {
  Gain gain;
  gain.signal = to_decibels(PowerRatio{});
  Arrivals found = arrivals(from_W, to_W, frequency_Hz);
  if (found.paths.empty()) {
    gain.first = first_arrival(from_W, to_W, frequency_Hz);
    return gain;
  }
  gain.first = found.arrival(first_path(found.paths), from_W, to_W);
  // An obstacle affects the paths without a bounce; where it leaves nothing, an echo is the first arrival.
  Arrivals left;
  left.shadow = found.shadow;
  for (std::size_t i = 0; i < found.paths.size(); ++i) {
    PathGain path = found.paths[i];
    if (!found.ways[i].bounces) path.gain += direct;
    if (std::isinf(path.gain.dB())) continue;
    left.paths.push_back(path);
    left.ways.push_back(found.ways[i]);
  }
  if (left.paths.empty()) return gain;
  const std::size_t first = first_path(left.paths);
  const double begins_s = left.paths[first].delay_s;
  if (begins_s > gain.first->travel_time_s) {
    gain.later_s = begins_s - gain.first->travel_time_s;
    gain.first = left.arrival(first, from_W, to_W);
  }
  const MultipathConfig* const multipath = config_.multipath ? &*config_.multipath : nullptr;
  const double window_s = multipath != nullptr ? multipath->window_s : std::numeric_limits<double>::infinity();
  // Echoes that a receiver may take for the first arrival.
  if (config_.echo_lock)
    for (std::size_t i = 0; i < left.paths.size(); ++i) {
      const double later_s = left.paths[i].delay_s - begins_s;
      if (later_s > 0 && later_s <= window_s)
        gain.echoes.push_back(
            {later_s, to_power(left.paths[i].gain - left.paths[first].gain), left.arrival(i, from_W, to_W).arrives_W});
    }
  // The sum.  Sound that comes a little before the first arrival belongs to the signal too, and is not drawn apart.
  std::swap(left.paths[0], left.paths[first]);
  if (multipath != nullptr && multipath->phases == MultipathConfig::Phases::random)
    randomize_phases(left.paths, random);
  for (PathGain& path : left.paths)
    if (begins_s - path.delay_s <= window_s) path.delay_s = std::max(path.delay_s, begins_s);
  // Earlier sound is interference, as later sound is.
  for (PathGain& path : left.paths)
    if (path.delay_s < begins_s) path.delay_s = begins_s + window_s + 1e-3;
  const MultipathSum sum = combine(left.paths, window_s);
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
    echoes.push_back({later_s, to_power(gains[i].gain - gains[0].gain), ray_direction_W(from_W, to_W, elevation_rad)});
  }
  return echoes;
}

}  // namespace sim
