#include "devices/sonar_return.hpp"

#include <algorithm>
#include <cmath>

#include "devices/ray_filter.hpp"
#include "sim/world/world.hpp"

namespace devices {

void SonarParams::read(sim::ParamReader& in) {
  in.read("range_min_m", range_min_m, sim::at_least(0), "echoes from nearer are not heard: the sonar still sends");
  in.read("range_max_m", range_max_m, sim::above_to(0, 20000), "how long it listens");
  in.read("sound_speed_mps", sound_speed_mps, sim::between(100, 10000), "1500 in water, 343 in air");
  in.read("absorption_dBpkm", absorption_dBpkm, sim::at_least(0), "loss of sound on its way, dB per km");
  in.read("source_level_dB", source_level_dB, sim::between(0, 300), "re 1 uPa at 1 m");
  in.read("pulse_s", pulse_s, sim::above_to(0, 1), "length of the ping; c pulse / 2 is the resolution in range");
  in.read_choice("tvg", tvg, {"none", "20log", "40log"},
                 "gain that grows with range: 20 or 40 log10 r, and twice the absorption");
  in.read("speckle", speckle, "strengths fluctuate from ping to ping, with a Rayleigh amplitude");
  in.read("sees_own_vehicle", sees_own_vehicle, "sound hits the parts of the own vehicle");
  in.read_references("see_through", see_through, "category", "categories of parts that sound passes");
  if (!in.describing() && range_min_m >= range_max_m) in.error("range_min_m", "'range_min_m' must be < range_max_m");
}

void SonarDetectionParams::read(sim::ParamReader& in) {
  in.read("threshold_dB", threshold_dB, sim::any_number(), "echo level that is heard, re 1 uPa, before the gain");
}

double beam_response(double off_axis_rad, double width_rad) {
  const double half_widths = 2 * off_axis_rad / width_rad;
  return std::exp2(-half_widths * half_widths);
}

double speckle_power(sim::Random& random) {
  return -std::log(random.uniform());
}

SonarReceiver::SonarReceiver(const SonarParams& params, const sim::DeviceContext& context)
    : physics_(context.world.physics()), own_group_(context.vehicle.group()) {
  change(params);
}

void SonarReceiver::change(const SonarParams& params) {
  params_ = params;
  source_uPa2_ = std::pow(10, params.source_level_dB / 10);
  filter_ = make_ray_filter(physics_, sim::RayKind::sound, params.see_through, own_group_, params.sees_own_vehicle);
}

void SonarReceiver::cast(const sim::Scene& scene, const sim::Pose& X_WS, std::span<const SonarRay> rays_S) {
  rays_W_.resize(rays_S.size());
  hits_.resize(rays_S.size());
  for (std::size_t i = 0; i < rays_S.size(); ++i)
    rays_W_[i] = {X_WS.translation(), X_WS.linear() * rays_S[i].direction_S, params_.range_max_m};
  scene.cast(rays_W_, filter_, hits_);
}

SonarEcho SonarReceiver::echo(std::size_t ray, const SonarRay& ray_S) const {
  const sim::RayHit& hit = hits_[ray];
  if (!hit.hit() || hit.range_m < params_.range_min_m || hit.range_m <= 0) return {};
  const double cosine = std::clamp(-hit.normal_W.dot(rays_W_[ray].direction_W), 0.0, 1.0);
  // 2 a r dB as a power: 10^(-2 a r / 10).
  const double loss_dB = 2 * params_.absorption_dBpkm * 1e-3 * hit.range_m;
  const double scatter_dB = physics_.material(hit.material).sound.backscatter_dB;
  const double power = source_uPa2_ * ray_S.weight * ray_S.solid_angle_sr * cosine / (hit.range_m * hit.range_m) *
                       std::pow(10, (scatter_dB - loss_dB) / 10);
  return {hit.range_m, power};
}

double SonarReceiver::range_slope(std::size_t ray, const sim::Vector3d& tangent_W) const {
  const sim::RayHit& hit = hits_[ray];
  // Grazing, a patch would be without end; 20 ranges per radian is 3 deg.
  const double cosine = std::max(std::abs(hit.normal_W.dot(rays_W_[ray].direction_W)), 0.05);
  return hit.range_m * std::abs(hit.normal_W.dot(tangent_W)) / cosine;
}

double SonarReceiver::gain_dB(double range_m) const {
  if (params_.tvg == "none") return 0;
  const double steps = params_.tvg == "40log" ? 40 : 20;
  return steps * std::log10(std::max(range_m, 1e-3)) + 2 * params_.absorption_dBpkm * 1e-3 * range_m;
}

}  // namespace devices
