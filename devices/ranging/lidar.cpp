// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/lidar.hpp"

#include <algorithm>
#include <cmath>

#include "devices/ranging/ray_casting.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "sim/config/presets.hpp"
#include "sim/world/world.hpp"

namespace devices {

const sim::Presets& lidar_presets();  // lidar_presets.yaml

void Lidar::Params::read(sim::ParamReader& in) {
  lidar_presets().read(in, *this, {"none"}, "preset of a product by its data sheet; the keys below override it");
  in.read("beams", beams, sim::between(1, 100000), "rays per scan");
  in.read_deg("fov_deg", fov_rad, sim::between(0, 360), "angle the fan covers");
  in.read("intensities", intensities, "the message also holds the intensity of each return");
  laser.read(in);
  if (in.describing()) return;
  const RayFactor factors[] = {{"beams", double(beams)}, {"beam_samples", double(laser.beam_samples)}};
  check_rays(in, factors);
}

Lidar::Lidar(const Params& params, const sim::DeviceContext& context) : receiver_(params.laser, context) {
  change(params);
}

void Lidar::change(const Params& params) {
  params_ = params;
  receiver_.change(params.laser);
  const auto beams = static_cast<std::size_t>(params.beams);
  returns_.assign(beams, params.laser.range_max_m);
  digest_.renew();
  fan_.count = params.beams;
  fan_.range_max_m = params.laser.range_max_m;
  fan_.first_angle_rad = params.beams == 1 ? 0.0 : -0.5 * params.fov_rad;
  // In a full circle the last beam does not coincide with the first.
  const bool full_circle = params.fov_rad >= 2 * std::numbers::pi - 1e-9;
  const int gaps = full_circle ? params.beams : params.beams - 1;
  fan_.step_rad = gaps > 0 ? params.fov_rad / gaps : 0.0;

  rays_per_beam_ = receiver_.beam_pattern().size();
  // Directions of all rays, where the axes of the beams and their ranges are not all that matters.
  directions_S_ = {};
  if (rays_per_beam_ == 1 && ranges_suffice()) {
    returns_.intensities = std::vector<double>();  // without its memory, which `= {}` would keep
    return;
  }
  directions_S_.reserve(beams * rays_per_beam_);
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle_rad = fan_.first_angle_rad + static_cast<double>(i) * fan_.step_rad;
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    for (const sim::Vector3d& d : receiver_.beam_pattern())
      directions_S_.emplace_back(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
  }
}

/// Returns whether the ranges follow directly from the hits, without material effects.
bool Lidar::ranges_suffice() const {
  return !params_.intensities && receiver_.sees_all();
}

/// Returns memory for the hits of a scan, which all lidars of a thread share.
std::span<sim::RayHit> Lidar::hits() const {
  static thread_local std::vector<sim::RayHit> all;
  all.resize(static_cast<std::size_t>(rays()));
  return all;
}

void Lidar::measure(const sim::SenseContext& context) {
  digest_.renew();
  if (rays_per_beam_ == 1)
    measure_axes(context);
  else
    measure_beams(context);
}

void Lidar::measure_axes(const sim::SenseContext& context) {
  fan_.X_WS = context.X_WS;
  const std::span<sim::RayHit> hits = this->hits();
  context.world.scene().cast_fan(fan_, receiver_.filter(), hits);
  // Without intensities and losses the ranges are all that a scan needs, and the receiver is left out.
  if (ranges_suffice()) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const double range_m = hits[i].range_m;
      const bool too_near = range_m < params_.laser.range_min_m;
      returns_.ranges_m[i] = std::clamp(range_m, params_.laser.range_min_m, params_.laser.range_max_m);
      returns_.returned[i] = too_near        ? LaserReturns::too_near
                             : hits[i].hit() ? LaserReturns::echo
                                             : LaserReturns::none;
    }
    return;
  }
  for (std::size_t i = 0; i < hits.size(); ++i)
    receiver_.receive(hits[i], context.X_WS.linear() * directions_S_[i], returns_, i);
}

void Lidar::measure_beams(const sim::SenseContext& context) {
  static thread_local std::vector<sim::Ray> rays;
  rays.resize(directions_S_.size());
  const std::span<sim::RayHit> hits = this->hits();
  for (std::size_t k = 0; k < rays.size(); ++k)
    rays[k] = {context.X_WS.translation(), context.X_WS.linear() * directions_S_[k], params_.laser.range_max_m};
  context.world.scene().cast(rays, receiver_.filter(), hits);
  const std::size_t samples = rays_per_beam_;
  for (std::size_t i = 0; i < returns_.size(); ++i)
    receiver_.receive(hits.subspan(i * samples, samples), std::span(rays).subspan(i * samples, samples), returns_, i);
}

void Lidar::disturb(double dt_s, sim::Random& random) {
  receiver_.disturb(returns_, dt_s, random);
}

std::span<const double> Lidar::intensities() const {
  return params_.intensities ? std::span<const double>(returns_.intensities) : std::span<const double>();
}

void Lidar::visit_state(sim::StateArchive& archive) {
  digest_.visit(archive, returns_.ranges_m, intensities());
  archive(receiver_);
}

// Publishes shoal.planar_lidar_t, equal on the wire to bot_core's.
void fill(const Lidar& lidar, shoal::planar_lidar_t& message) {
  const std::vector<double>& ranges_m = lidar.ranges_m();
  const std::span<const double> intensities = lidar.intensities();
  message.nranges = static_cast<std::int32_t>(ranges_m.size());
  message.ranges.resize(ranges_m.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) message.ranges[i] = static_cast<float>(ranges_m[i]);
  message.nintensities = static_cast<std::int32_t>(intensities.size());
  message.intensities.resize(intensities.size());
  for (std::size_t i = 0; i < intensities.size(); ++i) message.intensities[i] = static_cast<float>(intensities[i]);
  message.rad0 = static_cast<float>(lidar.first_angle_rad());
  message.radstep = static_cast<float>(lidar.step_rad());
}

SHOAL_SENSOR("lidar", Lidar, shoal::planar_lidar_t);

}  // namespace devices
