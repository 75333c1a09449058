// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "sim/acoustics/propagation/multipath.hpp"
#include "sim/acoustics/rays/ray_tables.hpp"
#include "sim/medium/sea_water.hpp"

namespace sim {

Propagation::Propagation(const AcousticsConfig& config, const Medium& medium, const PhysicsWorld& physics)
    : config_(config), medium_(medium), physics_(physics) {
  if (medium.has_water() && sound_paths(config, medium.has_sound_profile()) == SoundPaths::rays)
    rays_ = std::make_unique<RayTables>([&medium](double depth_m) { return medium.sound_speed_at_depth_mps(depth_m); },
                                        medium.profile_depths_m());
}

Propagation::~Propagation() = default;

Decibels Propagation::transmission_loss(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const {
  const double range_m = (to_W - from_W).norm();
  const double dBpkm = absorption_dBpkm(config_.absorption, frequency_Hz, medium_, from_W, to_W);
  return spreading_loss(range_m, straight_spreading(config_, medium_.has_sound_profile())) +
         absorption_loss(range_m, dBpkm);
}

Propagation::Band Propagation::band(double centre_Hz, double bandwidth_Hz) const {
  for (const Band& known : bands_)
    if (known.centre_Hz == centre_Hz && known.bandwidth_Hz == bandwidth_Hz) return known;
  const AmbientNoise noise = config_.noise.with_wind(medium_.mean_wind_mps());
  const Decibels ambient = noise.band_level(centre_Hz, bandwidth_Hz);
  const Band band{centre_Hz, bandwidth_Hz, ambient, to_power(ambient), min_absorption_dBpkm(centre_Hz)};
  constexpr std::size_t max_bands = 64;
  if (bands_.size() < max_bands) bands_.push_back(band);
  return band;
}

Decibels Propagation::ambient_level(double centre_Hz, double bandwidth_Hz) const {
  return band(centre_Hz, bandwidth_Hz).ambient;
}

PowerRatio Propagation::ambient_power(double centre_Hz, double bandwidth_Hz, Decibels less) const {
  const Band of = band(centre_Hz, bandwidth_Hz);
  return less.dB() == 0 ? of.ambient_power : to_power(of.ambient - less);
}

std::array<double, Propagation::depths_m.size()> Propagation::min_absorption_dBpkm(double frequency_Hz) const {
  std::array<double, depths_m.size()> min_dBpkm;
  double lowest_dBpkm = std::numeric_limits<double>::infinity();
  const double surface_m = medium_.highest_surface_m();
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    const Vector3d p_W(0, 0, surface_m - depths_m[i]);
    lowest_dBpkm = std::min(lowest_dBpkm, absorption_dBpkm(config_.absorption, frequency_Hz, medium_, p_W, p_W));
    min_dBpkm[i] = 0.95 * lowest_dBpkm;  // margin for the depths in between
  }
  return min_dBpkm;
}

double Propagation::audible_range_m(const Signal& signal, Decibels below, double deepest_m) const {
  const Band of = band(signal.centre_Hz, signal.bandwidth_Hz);
  const auto depth = std::lower_bound(depths_m.begin(), depths_m.end() - 1, deepest_m);
  const double min_dBpkm = of.min_dBpkm[static_cast<std::size_t>(depth - depths_m.begin())];
  const Decibels floor = of.ambient - below;
  const double max_m = config_.range_max_m.value_or(1e6);
  const SpreadingConfig spreading = bends() ? SpreadingConfig{} : config_.spreading;
  // Bisect the range on a logarithmic scale.
  const auto received = [&](double range_m) {
    return signal.source_level - spreading_loss(range_m, spreading) - absorption_loss(range_m, min_dBpkm) > floor;
  };
  if (received(max_m)) return max_m;
  double near_m = 1, far_m = max_m;
  for (int i = 0; i < 30; ++i) {
    const double middle_m = std::sqrt(near_m * far_m);
    (received(middle_m) ? near_m : far_m) = middle_m;
  }
  return far_m;
}

double Propagation::free_part(const Vector3d& from_W, int from_group, const Vector3d& to_W, int to_group,
                              double frequency_Hz) const {
  const Vector3d displacement_W = from_W - to_W;
  const double length_m = displacement_W.norm();
  if (length_m < 1e-3) return 1;
  RayFilter filter;
  filter.kind = RayKind::sound;
  filter.exclude_group = to_group;
  // Cast from the receiver to the past position of the sender; the sender's own hull, which has moved on, does not
  // block.
  const auto ray = [](const Vector3d& p_W, const Vector3d& q_W) {
    const Vector3d d_W = q_W - p_W;
    const double d_m = d_W.norm();
    return d_m > 1e-3 ? Ray{p_W, d_W / d_m, d_m - 1e-3} : Ray{p_W, Vector3d::UnitX(), 0};
  };
  const auto blocks = [&](int part) { return physics_.parts()[static_cast<std::size_t>(part)].group != from_group; };
  const Ray direct = ray(to_W, from_W);
  const auto found = physics_.scene().cast(direct.origin_W, direct.direction_W, direct.range_max_m, filter);
  if (!found || !blocks(found->part)) return 1;
  // The direct path is blocked.  Sound diffracts around obstacles smaller than the first Fresnel zone; the free
  // fraction of the rim of that zone approximates the sound that passes.
  const double at_m = found->range_m;
  const double wavelength_m = medium_.sound_speed_mps(to_W) / frequency_Hz;
  const double radius_m = std::sqrt(wavelength_m * at_m * (length_m - at_m) / length_m);
  const Vector3d along_W = displacement_W / length_m;
  const Vector3d across_W = along_W.unitOrthogonal(), other_W = along_W.cross(across_W);
  constexpr int rim = 8;
  std::array<Vector3d, rim> bends_W;
  std::size_t free = 0;
  for (int i = 0; i < rim; ++i) {
    const double angle = 2 * std::numbers::pi * i / rim;
    const Vector3d bend_W = to_W + along_W * at_m + radius_m * (std::cos(angle) * across_W + std::sin(angle) * other_W);
    if (medium_.in_water(bend_W)) bends_W[free++] = bend_W;
  }
  // Keep the bends that both ends reach; rays of nearly one direction are cast together.
  const auto keep_free = [&](const auto& ray_of) {
    std::array<Ray, rim> rays;
    std::array<RayHit, rim> hits;
    for (std::size_t i = 0; i < free; ++i) rays[i] = ray_of(bends_W[i]);
    physics_.scene().cast(std::span(rays).first(free), filter, std::span(hits).first(free));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < free; ++i)
      if (!hits[i].hit() || !blocks(hits[i].part)) bends_W[kept++] = bends_W[i];
    free = kept;
  };
  keep_free([&](const Vector3d& bend_W) { return ray(to_W, bend_W); });
  keep_free([&](const Vector3d& bend_W) { return ray(bend_W, from_W); });
  return static_cast<double>(free) / (rim + 1);
}

double Propagation::water_depth_m(const Vector3d& p_W) const {
  if (config_.multipath && config_.multipath->water_depth_m) return *config_.multipath->water_depth_m;
  // Only fixed bodies are bottom: skip moving ones.
  RayFilter filter;
  filter.kind = RayKind::sound;
  double below_m = 0;
  for (int passed = 0; passed < 8; ++passed) {
    const auto hit =
        physics_.scene().cast(p_W - below_m * Vector3d::UnitZ(), -Vector3d::UnitZ(), deepest_sea_m - below_m, filter);
    if (!hit) break;
    below_m += hit->range_m;
    const PartInfo& part = physics_.parts()[static_cast<std::size_t>(hit->part)];
    if (physics_.bodies()[static_cast<std::size_t>(part.body)]->fixed())
      return std::max(0.0, medium_.depth_m(p_W)) + below_m;
    below_m += 1e-3;
  }
  return std::numeric_limits<double>::infinity();
}

LinkDepths Propagation::link_depths(const Vector3d& from_W, const Vector3d& to_W) const {
  LinkDepths depths;
  depths.source_m = medium_.depth_m(from_W);
  depths.receiver_m = medium_.depth_m(to_W);
  depths.horizontal_m = (to_W - from_W).head<2>().norm();
  depths.water_m = water_depth_m((from_W + to_W) / 2);
  return depths;
}

MultipathMedium Propagation::water_between(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const {
  MultipathMedium water;
  water.frequency_Hz = frequency_Hz;
  water.sound_speed_mps = 1 / medium_.mean_slowness_spm(from_W.z(), to_W.z());
  water.absorption_dBpkm = absorption_dBpkm(config_.absorption, frequency_Hz, medium_, from_W, to_W);
  water.wind_mps = config_.noise.wind_mps.value_or(medium_.mean_wind_mps());
  water.spreading = straight_spreading(config_, medium_.has_sound_profile());
  return water;
}

Echoes Propagation::echoes_of(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz, Decibels direct,
                              Random& random) const {
  return echoes(*config_.multipath, water_between(from_W, to_W, frequency_Hz), link_depths(from_W, to_W), &random,
                direct);
}

Propagation::Gain Propagation::gain(const Vector3d& from_W, int from_group, const Vector3d& to_W, int to_group,
                                    double frequency_Hz, Random& random) const {
  Gain gain;
  const double free = config_.occlusion ? free_part(from_W, from_group, to_W, to_group, frequency_Hz) : 1;
  gain.blocked = free == 0;
  Decibels direct;
  if (free < 1) {
    // Sound diffracted around the obstacle, or transmitted through it.
    const double through = config_.occlusion_loss_dB ? std::pow(10.0, -*config_.occlusion_loss_dB / 20) : 0;
    direct = pressure_level(std::max(free, through));
  }
  if (rays_) {
    const bool blocked = gain.blocked;
    gain = gain_of_rays(from_W, to_W, frequency_Hz, direct, random);
    gain.blocked = blocked;
  } else if (config_.multipath) {
    gain.signal = -transmission_loss(from_W, to_W, frequency_Hz);
    const Echoes echoes = echoes_of(from_W, to_W, frequency_Hz, direct, random);
    gain.disturbing = to_power(gain.signal) * echoes.late;
    gain.signal += to_decibels(echoes.signal);
    gain.later_s = echoes.later_s;
    if (config_.echo_lock && free == 1) gain.echoes = straight_echoes(from_W, to_W, frequency_Hz);
  } else {
    gain.signal = direct - transmission_loss(from_W, to_W, frequency_Hz);
  }
  // Fading acts on signal and echoes alike.
  const Decibels faded = fade(config_.fading, random);
  gain.signal += faded;
  if (gain.disturbing.linear() > 0) gain.disturbing = to_power(faded) * gain.disturbing;
  return gain;
}

}  // namespace sim
