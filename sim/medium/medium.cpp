// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/medium.hpp"

#include <algorithm>
#include <limits>

#include "sim/base/log.hpp"
#include "sim/medium/water_column.hpp"

namespace sim {

namespace {

constexpr double air_density_kgpm3 = 1.225;  // ISA, sea level
constexpr double air_pressure_Pa = 101325;   // ISA, sea level
constexpr double air_temperature_C = 15;     // ISA, sea level
constexpr double sound_in_air_mps = 340.3;   // ISA, sea level
constexpr double dry = -std::numeric_limits<double>::infinity();

}  // namespace

Medium::Medium(const MediumConfig& config, double gravity_mps2, std::uint64_t seed)
    : config_(config), gravity_mps2_(gravity_mps2), still_m_(dry) {
  if (config.water) {
    column_.emplace(*config.water, gravity_mps2);
    if (const auto depth_m = unstable_at_m(*config.water, *column_))
      log_warn("medium: water: 'profile' is lighter at {:g} m than above it: such water would overturn", *depth_m);
    current_.emplace(config.current, config.tides, seed);
    if (config.waves) waves_.emplace(*config.waves, gravity_mps2, seed);
  }
  if (config.wind) wind_.emplace(*config.wind, seed);
  advance_to(Time{0});
}

void Medium::advance_to(Time now) {
  now_ = now;
  if (has_water()) {
    still_m_ = config_.water->surface_m + Current::tide_m(config_.tides, now);
    current_->advance_to(now);
    if (waves_) waves_->advance_to(now);
  }
  if (wind_) wind_->advance_to(now);
}

std::span<const WaveComponent> Medium::wave_components() const {
  return waves_ ? std::span<const WaveComponent>(waves_->components()) : std::span<const WaveComponent>();
}

double Medium::surface_m(double x_m, double y_m) const {
  return waves_ ? still_m_ + waves_->elevation_m(x_m, y_m) : still_m_;
}

double Medium::surface_m(double x_m, double y_m, Time at) const {
  if (!has_water()) return dry;
  const double still_m = config_.water->surface_m + Current::tide_m(config_.tides, at);
  return waves_ ? still_m + waves_->elevation_m(x_m, y_m, at) : still_m;
}

LocalWater Medium::water_at(const Vector3d& p_W) const {
  LocalWater water;
  water.surface_m = still_m_;
  if (!has_water()) return water;
  if (waves_) {
    const WaveMotion motion = waves_->at(p_W.x(), p_W.y(), p_W.z() - still_m_);
    water.surface_m += motion.elevation_m;
    water.velocity_W = motion.velocity_W;
    water.acceleration_W = motion.acceleration_W;
  }
  // Depth counts from the wavy surface: a layer moves up and down with it.
  const double depth_m = water.surface_m - p_W.z();
  water.density_kgpm3 = column_->density_kgpm3(depth_m);
  water.velocity_W += current_->velocity_W(p_W.x(), p_W.y(), depth_m);
  return water;
}

Vector3d Medium::water_velocity_W(const Vector3d& p_W) const {
  Vector3d v_W = Vector3d::Zero();
  if (!has_water()) return v_W;
  double surface_m = still_m_;
  if (waves_) {
    const WaveMotion motion = waves_->at(p_W.x(), p_W.y(), p_W.z() - still_m_);
    surface_m += motion.elevation_m;
    v_W = motion.velocity_W;
  }
  return v_W + current_->velocity_W(p_W.x(), p_W.y(), surface_m - p_W.z());
}

Vector3d Medium::air_velocity_W(const Vector3d& p_W) const {
  if (!wind_) return Vector3d::Zero();
  return wind_->velocity_W(p_W.z() - (has_water() ? still_m_ : 0));
}

double Medium::mean_wind_mps() const {
  return config_.wind ? config_.wind->mean_mps().head<2>().norm() : 0;
}

double Medium::density_kgpm3(const Vector3d& p_W) const {
  const double depth = depth_m(p_W);
  return depth > 0 ? column_->density_kgpm3(depth) : air_density_kgpm3;
}

double Medium::pressure_Pa(const Vector3d& p_W) const {
  if (!has_water()) return air_pressure_Pa;
  const double z_m = p_W.z() - still_m_;
  if (!waves_) return air_pressure_Pa + column_->pressure_Pa(-z_m);
  const WaveMotion motion = waves_->at(p_W.x(), p_W.y(), z_m);
  if (z_m >= motion.elevation_m) return air_pressure_Pa;
  const double by_head = column_->density_kgpm3(0) * gravity_mps2_;
  const double still_Pa = z_m < 0 ? column_->pressure_Pa(-z_m) : -by_head * z_m;
  return air_pressure_Pa + std::max(0.0, still_Pa + by_head * motion.head_m);
}

double Medium::temperature_C(const Vector3d& p_W) const {
  return has_water() ? column_->temperature_C(depth_m(p_W)) : air_temperature_C;
}

double Medium::salinity_psu(const Vector3d& p_W) const {
  return has_water() ? column_->salinity_psu(depth_m(p_W)) : 0;
}

double Medium::sound_speed_mps(const Vector3d& p_W) const {
  const double depth = depth_m(p_W);
  return depth > 0 ? column_->sound_speed_mps(depth) : sound_in_air_mps;
}

double Medium::mean_slowness_spm(double z_m, double other_z_m) const {
  return has_water() ? column_->mean_slowness_spm(still_m_ - z_m, still_m_ - other_z_m) : 1 / sound_in_air_mps;
}

std::vector<double> Medium::profile_depths_m() const {
  std::vector<double> depths_m;
  if (has_water())
    for (const WaterLayerConfig& row : config_.water->profile) depths_m.push_back(row.depth_m);
  return depths_m;
}

bool Medium::has_sound_profile() const {
  return has_water() && config_.water->profile.size() > 1 && !config_.water->sound_speed_mps;
}

void Medium::visit_state(StateArchive& archive) {
  const bool changes = has_water() || wind_;
  changes ? archive(now_) : archive.unhashed(now_);
  if (current_) archive(*current_);
  if (wind_) archive(*wind_);
  if (archive.restoring()) advance_to(now_);
}

}  // namespace sim
