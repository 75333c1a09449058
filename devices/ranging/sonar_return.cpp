// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/sonar_return.hpp"

#include <algorithm>
#include <cmath>

#include "devices/ranging/ray_casting.hpp"
#include "sim/medium/sea_water.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

constexpr double dry_sound_speed_mps = 1500;  // in worlds without water, unless configured
constexpr int surface_material = -1;          // material of a hit of the water surface

bool works(SonarParams::WorksIn where, bool wet) {
  switch (where) {
    case SonarParams::WorksIn::water:
      return wet;
    case SonarParams::WorksIn::air:
      return !wet;
    case SonarParams::WorksIn::any:
      break;
  }
  return true;
}

}  // namespace

void SonarParams::read(sim::ParamReader& in) {
  in.read("range_min_m", range_min_m, sim::at_least(0),
          "minimum range: closer echoes are lost while the sonar transmits");
  in.read("range_max_m", range_max_m, sim::above_to(0, 20000), "maximum range, which sets the listening time");
  // Medium.
  in.read_choice(
      "works_in", works_in, {{"water", WorksIn::water}, {"air", WorksIn::air}, {"any", WorksIn::any}},
      "in a world with water: the medium in which it works; on the other side of the surface it receives nothing");
  in.read("sound_speed_mps", sound_speed_mps, sim::between(100, 10000),
          "true speed of sound; unset: that of the medium at the sonar, 1500 in a world without water");
  in.read("assumed_sound_speed_mps", assumed_sound_speed_mps, sim::between(100, 10000),
          "speed of sound with which the sonar converts times to ranges; unset: the true speed");
  in.read("absorption_dBpkm", absorption_dBpkm, sim::at_least(0),
          "absorption of sound, dB per km; unset: that of the water for frequency_kHz, else 0");
  in.read("frequency_kHz", frequency_kHz, sim::between(0.1, 10000),
          "frequency of the sound, for the absorption of the water");
  // Echo of the water surface.
  in.read("surface_echo", surface_echo, "the water surface returns an echo; otherwise rays that reach it are lost");
  in.read("surface_backscatter_dB", surface_backscatter_dB, sim::between(-100, 0),
          "backscatter strength of the water surface");
  // Transmitter, receiver and filter.
  in.read("source_level_dB", source_level_dB, sim::between(0, 300), "re 1 uPa at 1 m");
  in.read("pulse_s", pulse_s, sim::above_to(0, 1), "length of the ping; c pulse / 2 is the resolution in range");
  in.read_choice("tvg", tvg, {{"none", Gain::none}, {"20log", Gain::log20}, {"40log", Gain::log40}},
                 "gain that grows with range: 20 or 40 log10 r, and twice the absorption");
  in.read("speckle", speckle, "strengths fluctuate from ping to ping, with a Rayleigh amplitude");
  in.read("sees_own_vehicle", sees_own_vehicle, "rays also hit parts of its own vehicle");
  in.read_references("see_through", see_through, "category", "categories of parts that sound passes through");
  if (!in.describing() && range_min_m >= range_max_m) in.error("range_min_m", "'range_min_m' must be < range_max_m");
}

void SonarDetectionParams::read(sim::ParamReader& in) {
  in.read("threshold_dB", threshold_dB, sim::any_number(), "minimum detectable echo level, re 1 uPa, before the gain");
}

double beam_response(double off_axis_rad, double width_rad) {
  const double half_widths = 2 * off_axis_rad / width_rad;
  return std::exp2(-half_widths * half_widths);
}

double speckle_power(sim::Random& random) {
  return -std::log(random.uniform());
}

SonarReceiver::SonarReceiver(const SonarParams& params, const sim::DeviceContext& context)
    : physics_(context.world.physics()), medium_(context.world.medium()), own_group_(context.vehicle.group()) {
  change(params);
}

void SonarReceiver::change(const SonarParams& params) {
  params_ = params;
  source_uPa2_ = std::pow(10, params.source_level_dB / 10);
  filter_ = make_ray_filter(physics_, sim::RayKind::sound, params.see_through, own_group_, params.sees_own_vehicle);
  sound_speed_mps_ = params.sound_speed_mps.value_or(dry_sound_speed_mps);
  absorption_dBpm_ = params.absorption_dBpkm.value_or(0) * 1e-3;
  range_scale_ = params.assumed_sound_speed_mps.value_or(sound_speed_mps_) / sound_speed_mps_;
}

bool SonarReceiver::update_medium(const sim::Vector3d& p_WS) {
  if (!medium_.has_water()) return true;
  const bool wet = medium_.in_water(p_WS);
  if (!works(params_.works_in, wet)) return false;
  sound_speed_mps_ = params_.sound_speed_mps ? *params_.sound_speed_mps : medium_.sound_speed_mps(p_WS);
  range_scale_ = params_.assumed_sound_speed_mps.value_or(sound_speed_mps_) / sound_speed_mps_;
  if (params_.frequency_kHz && !params_.absorption_dBpkm && wet) {
    const sim::SeaWater water{medium_.temperature_C(p_WS), medium_.salinity_psu(p_WS), medium_.depth_m(p_WS)};
    absorption_dBpm_ = sim::francois_garrison_dBpkm(*params_.frequency_kHz, water) * 1e-3;
  }
  return true;
}

double SonarReceiver::range_to_surface_m(const sim::Ray& ray_W, double surface_m) const {
  const sim::Vector3d& o = ray_W.origin_W;
  const sim::Vector3d& d = ray_W.direction_W;
  if (d.z() == 0) return ray_W.range_max_m;
  // Intersect with the level at the sensor; in waves, iterate with the level at the intersection.
  double range_m = (surface_m - o.z()) / d.z();
  for (int i = 0; i < 2 && medium_.has_waves() && range_m > 0 && range_m < ray_W.range_max_m; ++i)
    range_m = (medium_.surface_m(o.x() + range_m * d.x(), o.y() + range_m * d.y()) - o.z()) / d.z();
  return range_m > 0 ? std::min(range_m, ray_W.range_max_m) : ray_W.range_max_m;
}

void SonarReceiver::cast(const sim::Scene& scene, const sim::Pose& X_WS, std::span<const SonarRay> rays_S) {
  rays_W_.resize(rays_S.size());
  hits_.assign(rays_S.size(), {});
  if (!update_medium(X_WS.translation())) return;
  // Rays in W, limited by the maximum range and the water surface.
  const double range_max_m = params_.range_max_m / range_scale_;
  for (std::size_t i = 0; i < rays_S.size(); ++i)
    rays_W_[i] = {X_WS.translation(), X_WS.linear() * rays_S[i].direction_S, range_max_m};
  if (medium_.has_water()) {
    const double surface_m = medium_.surface_m(X_WS.translation().x(), X_WS.translation().y());
    for (sim::Ray& ray_W : rays_W_) ray_W.range_max_m = range_to_surface_m(ray_W, surface_m);
  }
  // Cast them; add hits of the water surface if it returns echoes.
  scene.cast(rays_W_, filter_, hits_);
  if (!params_.surface_echo) return;
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    if (hits_[i].hit() || !(rays_W_[i].range_max_m < range_max_m)) continue;
    hits_[i].range_m = rays_W_[i].range_max_m;
    hits_[i].normal_W = {0, 0, rays_W_[i].direction_W.z() > 0 ? -1.0 : 1.0};
    hits_[i].material = surface_material;
  }
}

SonarEcho SonarReceiver::echo(std::size_t ray, const SonarRay& ray_S) const {
  const sim::RayHit& hit = hits_[ray];
  const bool surface = hit.material == surface_material;
  if (!hit.hit() && !surface) return {};
  if (hit.range_m * range_scale_ < params_.range_min_m || hit.range_m <= 0) return {};
  const double cosine = std::clamp(-hit.normal_W.dot(rays_W_[ray].direction_W), 0.0, 1.0);
  // Two-way absorption and scattering strength, dB.
  const double loss_dB = 2 * absorption_dBpm_ * hit.range_m;
  const double scatter_dB =
      surface ? params_.surface_backscatter_dB : physics_.material(hit.material).sound.backscatter_dB;
  const double power = source_uPa2_ * ray_S.weight * ray_S.solid_angle_sr * cosine / (hit.range_m * hit.range_m) *
                       std::pow(10, (scatter_dB - loss_dB) / 10);
  return {hit.range_m, power};
}

double SonarReceiver::range_slope(std::size_t ray, const sim::Vector3d& tangent_W) const {
  const sim::RayHit& hit = hits_[ray];
  // Limit the slope at grazing incidence to that at a grazing angle of 3 deg.
  const double cosine = std::max(std::abs(hit.normal_W.dot(rays_W_[ray].direction_W)), 0.05);
  return hit.range_m * std::abs(hit.normal_W.dot(tangent_W)) / cosine;
}

double SonarReceiver::gain_dB(double range_m) const {
  double steps = 0;
  switch (params_.tvg) {
    case SonarParams::Gain::none:
      return 0;
    case SonarParams::Gain::log20:
      steps = 20;
      break;
    case SonarParams::Gain::log40:
      steps = 40;
      break;
  }
  return steps * std::log10(std::max(range_m, 1e-3)) + 2 * absorption_dBpm_ * range_m;
}

}  // namespace devices
