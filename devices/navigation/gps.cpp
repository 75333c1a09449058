// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/gps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shoal/gps_data_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

/// Speed below which the course is held: the resolution of the speed of a u-blox receiver (UBX-NAV-PVT, gSpeed).
constexpr double course_min_mps = 1e-3;

/// Reports an error when another receiver disciplines the same clock.
void refuse_two_masters(const sim::DeviceContext& context) {
  for (const sim::DeviceConfig& device : context.vehicle.config().devices) {
    if (device.type != "gps" || device.name == context.config.name) continue;
    const auto& other = static_cast<const sim::detail::ParamsOf<Gps::Params>&>(*device.params).params;
    if (other.disciplines_clock)
      sim::throw_config_error(
          context.config.place, "device '" + context.full_name() + "'",
          "'disciplines_clock': '" + device.name + "' already disciplines the clock of this vehicle");
  }
}

}  // namespace

void Gps::Params::read(sim::ParamReader& in) {
  in.read("horizontal_noise", horizontal_noise, "error of east and of north, m");
  in.read("vertical_noise", vertical_noise, "error of the height, m");
  in.read("velocity_noise", velocity_noise, "error of each component of the velocity, m/s");
  in.read("fix_quality", fix_quality, sim::between(1, 2), "1: autonomous, 2: differential");
  in.read("satellites", satellites, sim::between(4, 40), "reported number of satellites");
  in.read("min_height_m", min_height_m, sim::any_number(), "below this height the antenna has no fix");
  in.read("reacquisition_s", reacquisition_s, sim::between(0, 1e6),
          "reacquisition time after a zone that denies it, or after water over the antenna");
  in.read("disciplines_clock", disciplines_clock, "disciplines the clock of its vehicle at every fix");
  in.read("discipline_time_constant_s", discipline.time_constant_s, sim::between(0.1, 1e5),
          "time constant of the critically damped loop that corrects the clock");
  in.read("step_above_s", discipline.step_above_s, sim::between(0, 1),
          "a larger error of the clock is corrected in one step");
  in.read("pps_std_s", discipline.pps_std_s, sim::between(0, 1), "jitter of the pulse that the clock is compared with");
}

Gps::Gps(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      geodesy_(context.world.geodesy()),
      clock_(context.vehicle.clock()),
      faults_(context.faults),
      config_(context.config),
      step_s_(sim::to_seconds(context.world.step_time())),
      horizontal_noise_(context, params, 2),
      vertical_noise_(context, params),
      velocity_noise_(context, params, 3) {
  if (params.disciplines_clock) refuse_two_masters(context);
}

void Gps::measure(const sim::SenseContext& context) {
  sampled_at_ = context.now;
  reading_.p_W = context.X_WS.translation();
  reading_.v_W = context.v_WS_W;
  reading_.fix_quality = params_.min_height_m && reading_.p_W.z() < *params_.min_height_m ? 0 : params_.fix_quality;
  const bool denied = context.world.zones().denied(sim::ZoneFlag::gps_denied, reading_.p_W);
  const bool submerged = context.world.medium().in_water(reading_.p_W);
  no_fix_ = submerged ? "fix under water" : denied ? "fix in a zone that denies it" : "fix";
  // The receiver starts to search again each time that the antenna is covered.
  if (denied || submerged) denied_at_ = context.now;
  if (denied_at_ && context.now <= *denied_at_ + sim::from_seconds(params_.reacquisition_s)) reading_.fix_quality = 0;
  reading_.position = geodesy_.to_geodetic(reading_.p_W);
  // The course is from true north of its own meridian, which turns against y of the world.
  find_course(true_course_rad_);
  true_course_rad_ = reading_.course_rad;
}

void Gps::find_course(double held_rad) {
  const sim::Vector3d v_E = geodesy_.local_axes_W(reading_.p_W).transpose() * reading_.v_W;
  reading_.speed_mps = std::hypot(v_E.x(), v_E.y());
  reading_.course_rad = reading_.speed_mps < course_min_mps ? held_rad : std::atan2(v_E.x(), v_E.y());
}

void Gps::disturb(double dt_s, sim::Random& random) {
  horizontal_noise_.apply(std::span<double>(reading_.p_W.data(), 2), dt_s, random);
  vertical_noise_.apply(reading_.p_W.z(), dt_s, random);
  velocity_noise_.apply(std::span<double>(reading_.v_W.data(), 3), dt_s, random);
  reading_.position = geodesy_.to_geodetic(reading_.p_W);
  find_course(true_course_rad_);
  if (params_.disciplines_clock) discipline(random);  // last, so that the other random draws do not depend on it
}

void Gps::discipline(sim::Random& random) {
  if (reading_.fix_quality == 0 || faults_.silent() || clock_.perfect()) return;
  sim::DisciplineParams loop = params_.discipline;
  loop.interval_s = config_.rate_hz > 0 ? std::max(1 / config_.rate_hz, step_s_) : step_s_;
  const double jitter_s = loop.pps_std_s * random.gaussian();
  clock_.discipline(sampled_at_, clock_.error_s(sampled_at_) + jitter_s, loop);
}

double Gps::accuracy_m(const sim::NoiseParams& noise) {
  return std::sqrt(noise.gaussian_std * noise.gaussian_std + noise.gauss_markov_std * noise.gauss_markov_std +
                   noise.bias_std * noise.bias_std + noise.uniform_half_width * noise.uniform_half_width / 3);
}

void GpsReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  const Gps::Reading& reading = gps_.reading();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const bool fix = reading.fix_quality > 0;
  shoal::gps_data_t message{};
  message.utime = out.utime(sampled_at);
  message.gps_lock = reading.fix_quality;
  message.longitude = fix ? reading.position.longitude_deg : nothing;
  message.latitude = fix ? reading.position.latitude_deg : nothing;
  message.elev = fix ? reading.position.height_m : nothing;
  message.horizontal_accuracy = fix ? Gps::accuracy_m(gps_.params().horizontal_noise) : nothing;
  message.vertical_accuracy = fix ? Gps::accuracy_m(gps_.params().vertical_noise) : nothing;
  message.numSatellites = fix ? gps_.params().satellites : 0;
  message.speed = fix ? reading.speed_mps : nothing;
  message.heading = fix ? reading.course_rad : nothing;
  for (int i = 0; i < 3; ++i) message.xyz_pos[i] = fix ? reading.p_W[i] : nothing;
  // Satellites provide the true time, independent of the vehicle clock.
  message.gps_time = static_cast<double>(fix ? out.true_utime(sampled_at) : message.utime) * 1e-6;
  shoal::encode_into(message, out.buffer());
  out.publish(out.buffer());
}

SHOAL_SENSOR("gps", Gps, GpsReporter);

}  // namespace devices
