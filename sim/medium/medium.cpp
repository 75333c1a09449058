#include "sim/medium/medium.hpp"

#include <algorithm>
#include <limits>

namespace sim {

namespace {

constexpr double air_density_kgpm3 = 1.225;  // ISA, sea level
constexpr double air_pressure_Pa = 101325;   // ISA, sea level
constexpr double sound_in_air_mps = 340.3;   // ISA, sea level, 15 C

/// Mackenzie 1981 (JASA 70, 807): m/s of degrees C, psu, m.
double mackenzie_mps(double T, double S, double D) {
  return 1448.96 + 4.591 * T - 5.304e-2 * T * T + 2.374e-4 * T * T * T + 1.340 * (S - 35) + 1.630e-2 * D +
         1.675e-7 * D * D - 1.025e-2 * T * (S - 35) - 7.139e-13 * T * D * D * D;
}

}  // namespace

Medium::Medium(const MediumConfig& config, double gravity_mps2, std::uint64_t)
    : config_(config), gravity_mps2_(gravity_mps2) {}

void Medium::advance_to(Time now) {
  now_ = now;
}

double Medium::surface_m(double, double) const {
  return has_water() ? config_.water->surface_m : -std::numeric_limits<double>::infinity();
}

LocalWater Medium::water_at(const Vector3d& p_W) const {
  LocalWater water;
  water.surface_m = surface_m(p_W.x(), p_W.y());
  if (!has_water()) return water;
  water.density_kgpm3 = config_.water->density_kgpm3;
  water.velocity_W = water_velocity_W(p_W);
  return water;
}

Vector3d Medium::water_velocity_W(const Vector3d&) const {
  return has_water() ? config_.current.velocity_mps : Vector3d::Zero();
}

Vector3d Medium::air_velocity_W(const Vector3d&) const {
  return Vector3d::Zero();
}

double Medium::density_kgpm3(const Vector3d& p_W) const {
  return in_water(p_W) ? config_.water->density_kgpm3 : air_density_kgpm3;
}

double Medium::pressure_Pa(const Vector3d& p_W) const {
  const double depth = depth_m(p_W);
  if (depth > 0) return air_pressure_Pa + config_.water->density_kgpm3 * gravity_mps2_ * depth;
  return air_pressure_Pa;
}

double Medium::temperature_C(const Vector3d&) const {
  return has_water() ? config_.water->temperature_C : 15;
}

double Medium::salinity_psu(const Vector3d&) const {
  return has_water() ? config_.water->salinity_psu : 0;
}

double Medium::sound_speed_mps(const Vector3d& p_W) const {
  const double depth = depth_m(p_W);
  return depth > 0 ? mackenzie_mps(temperature_C(p_W), salinity_psu(p_W), depth) : sound_in_air_mps;
}

void Medium::hash_state(StateHash& hash) const {
  if (!has_water()) return;
  hash.add(static_cast<std::int64_t>(now_.count()));
}

}  // namespace sim
