#include "devices/lidar.hpp"

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Lidar::Params::read(sim::ParamReader& in) {
  in.read("beams", beams, sim::between(1, 100000), "rays per scan");
  in.read_deg("fov_deg", fov_rad, sim::between(0, 360), "angle the fan covers");
  in.read("range_min_m", range_min_m, sim::at_least(0), "anything nearer reports this");
  in.read("range_max_m", range_max_m, sim::above(0), "a ray that hits nothing reports this");
  in.read("resolution_m", resolution_m, sim::at_least(0), "ranges are rounded to multiples of this; 0: not");
  in.read("sees_own_vehicle", sees_own_vehicle, "rays hit the parts of the own vehicle");
  in.read_references("see_through", see_through, "category", "categories of parts that rays pass");
  in.read("noise", noise, "error of each range, m");
  if (!in.describing() && range_min_m >= range_max_m) in.error("range_min_m", "'range_min_m' must be < range_max_m");
}

Lidar::Lidar(const Params& params, const sim::DeviceContext& context)
    : physics_(context.world.physics()),
      own_group_(context.vehicle.group()),
      noise_(context.noise(params.noise, 1, "noise")) {
  change(params);
}

void Lidar::change(const Params& params) {
  params_ = params;
  noise_.change(params.noise);
  ranges_m_.assign(static_cast<std::size_t>(params.beams), params.range_max_m);
  hits_.assign(ranges_m_.size(), {});
  fan_.count = params.beams;
  fan_.range_max_m = params.range_max_m;
  fan_.first_angle_rad = params.beams == 1 ? 0.0 : -0.5 * params.fov_rad;
  // A full circle has no last beam on top of the first.
  const bool full_circle = params.fov_rad >= 2 * std::numbers::pi - 1e-9;
  const int gaps = full_circle ? params.beams : params.beams - 1;
  fan_.step_rad = gaps > 0 ? params.fov_rad / gaps : 0.0;
  filter_ = {};
  for (const std::string& category : params.see_through) filter_.categories &= ~physics_.category_bit(category);
  if (!params.sees_own_vehicle) filter_.exclude_group = own_group_;
}

void Lidar::measure(const sim::SenseContext& context) {
  fan_.X_WS = context.X_WS;
  context.world.scene().cast_fan(fan_, filter_, hits_);
  for (std::size_t i = 0; i < ranges_m_.size(); ++i) {
    ranges_m_[i] = std::clamp(hits_[i].range_m, params_.range_min_m, params_.range_max_m);
  }
}

void Lidar::disturb(double dt_s, sim::Random& random) {
  noise_.apply(std::span<double>(ranges_m_), dt_s, random);
  for (std::size_t i = 0; i < ranges_m_.size(); ++i) {
    if (params_.resolution_m > 0) ranges_m_[i] = std::round(ranges_m_[i] / params_.resolution_m) * params_.resolution_m;
    ranges_m_[i] =
        hits_[i].hit() ? std::clamp(ranges_m_[i], params_.range_min_m, params_.range_max_m) : params_.range_max_m;
  }
}

void Lidar::hash_state(sim::StateHash& hash) const {
  hash.add(std::span<const double>(ranges_m_));
  noise_.hash_state(hash);
}

void LidarReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  static thread_local shoal::planar_lidar_t message;  // keeps its vectors from scan to scan
  const std::vector<double>& ranges_m = lidar_.ranges_m();
  message.utime = out.utime(sampled_at);
  message.nranges = static_cast<std::int32_t>(ranges_m.size());
  message.ranges.resize(ranges_m.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) message.ranges[i] = static_cast<float>(ranges_m[i]);
  message.nintensities = 0;
  message.rad0 = static_cast<float>(lidar_.first_angle_rad());
  message.radstep = static_cast<float>(lidar_.step_rad());
  shoal::encode_into(message, out.buffer());
  out.publish(out.buffer());
}

SHOAL_SENSOR("lidar", Lidar, LidarReporter);

}  // namespace devices
