// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/usbl.hpp"

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/usbl_t.hpp"
#include "sim/acoustics/rays/ray_trace.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Usbl::Params::read(sim::ParamReader& in) {
  interrogator.read(in);
  in.read("ping_period_s", ping_period_s, sim::between(0.01, 1e4), "between two pings, at least");
  in.read("assumed_sound_speed_mps", assumed_sound_speed_mps, sim::between(100, 10000),
          "speed of sound that converts times to ranges; unset: the true one at the sensor");
  in.read("assumed_water", assumed_water,
          "water that the user assumes: rays through it give positions; unset: straight lines");
  in.read("answer_dropout", answer_dropout, sim::between(0, 1),
          "probability that an answer is missed, drawn for each answer");
  in.read("range_noise", range_noise, "error of each range, m");
  in.read("array", array, "hydrophones whose errors depend on level and angle; unset: only the errors below");
  in.read("azimuth_noise", azimuth_noise, "error of each direction across it, rad; of a level one: of its azimuth");
  in.read("elevation_noise", elevation_noise, "error of the elevation of each direction, rad");
}

Usbl::Usbl(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      interrogator_(params.interrogator, context),
      range_noise_(context, params),
      azimuth_noise_(context, params),
      elevation_noise_(context, params),
      fault_(*context.noise_origin(params.azimuth_noise).fault) {
  warn_of_assumed_water(params_.assumed_water, context);
  assume();
}

void Usbl::change(const Params& params) {
  params_ = params;
  interrogator_.change(params.interrogator);
  assume();
}

void Usbl::assume() {
  assumed_.reset();
  if (params_.assumed_water) assumed_.emplace(*params_.assumed_water);
}

/// Replaces range and direction by those of the place which a ray back through the assumed water reaches in the time.
void Usbl::follow_ray(Fix& fix) const {
  const sim::Vector3d towards_W = R_WS_ * fix.position_S().normalized();
  const double level = towards_W.head<2>().norm();
  const sim::RayPlace place =
      sim::ray_place(assumed_->profile(), depth_m_, std::atan2(towards_W.z(), level), fix.range_m / assumed_mps_);
  sim::Vector3d p_W(0, 0, depth_m_ - place.depth_m);
  if (level > 0) p_W.head<2>() = towards_W.head<2>() / level * place.range_m;
  const sim::Vector3d p_S = R_WS_.transpose() * p_W;
  fix.range_m = p_S.norm();
  fix.point_at(p_S);
}

void Usbl::Fix::point_at(const sim::Vector3d& direction_S) {
  azimuth_rad = std::atan2(direction_S.y(), direction_S.x());
  elevation_rad = std::atan2(direction_S.z(), std::hypot(direction_S.x(), direction_S.y()));
}

sim::Vector3d Usbl::Fix::position_S() const {
  const double across_m = range_m * std::cos(elevation_rad);
  return {across_m * std::cos(azimuth_rad), across_m * std::sin(azimuth_rad), range_m * std::sin(elevation_rad)};
}

void Usbl::measure(const sim::SenseContext& context) {
  fixes_.clear();
  const sim::Medium& medium = context.world.medium();
  const sim::Vector3d& p_WS = context.X_WS.translation();
  for (const Interrogator::Answer& answer : interrogator_.take_answers()) {
    const auto azimuth_rad = [](const sim::Vector3d& p_S) { return std::atan2(p_S.y(), p_S.x()); };
    const auto elevation_rad = [](const sim::Vector3d& p_S) {
      return std::atan2(p_S.z(), std::hypot(p_S.x(), p_S.y()));
    };
    const UsblTone tone{sim::PowerRatio(answer.snr), answer.time_bandwidth,
                        medium.sound_speed_mps(p_WS) / answer.frequency_Hz};
    fixes_.push_back({answer.transponder, answer.two_way_s, answer.distance_m, azimuth_rad(answer.p_ST_S),
                      elevation_rad(answer.p_ST_S), azimuth_rad(answer.apparent_S), elevation_rad(answer.apparent_S),
                      params_.array ? params_.array->cosine_std(tone) : 0});
  }
  // The device converts times by the sound speed that it assumes, by default the true one at its transducer.
  assumed_mps_ = params_.assumed_sound_speed_mps.value_or(medium.sound_speed_mps(p_WS));
  R_WS_ = context.X_WS.linear();
  depth_m_ = medium.depth_m(p_WS);
  // The next ping waits for all answers: those of two pings could not be distinguished.
  if (context.now < next_ping_ || !interrogator_.done(context.now) || !medium.in_water(p_WS)) return;
  next_ping_ = context.now + sim::from_seconds(params_.ping_period_s);
  interrogator_.ping(context.now);
}

void Usbl::disturb(double dt_s, sim::Random& random) {
  since_fix_s_ += dt_s;
  for (Fix& fix : fixes_) {
    fix.range_m = fix.travel_time_s / 2 * assumed_mps_;
    // Time passes once for all answers of a ping: slow errors advance at the first, and stay for the others.
    range_noise_.apply(fix.range_m, since_fix_s_, random);
    disturb_direction(fix, random);
    fix.range_m = std::max(fix.range_m, 0.0);
    if (assumed_ && fix.range_m > 0) follow_ray(fix);
    fix.azimuth_rad = sim::wrap_angle(fix.azimuth_rad);
    since_fix_s_ = 0;
  }
  if (params_.answer_dropout > 0)
    std::erase_if(fixes_, [&](const Fix&) { return random.uniform() < params_.answer_dropout; });
}

void Usbl::disturb_direction(Fix& fix, sim::Random& random) {
  fix.azimuth_rad = fix.sound_azimuth_rad;
  fix.elevation_rad = fix.sound_elevation_rad;
  if (fix.cosine_std > 0) {
    const double std = fault_.factor * fix.cosine_std;
    const double error_x = std * random.gaussian(), error_y = std * random.gaussian();
    fix.point_at(with_cosine_errors(turned(fix.azimuth_rad, fix.elevation_rad, 0, 0), error_x, error_y));
  }
  // An azimuth has no meaning above the target, so its error is an angle across the direction.
  double azimuth_rad = fix.azimuth_rad, elevation_rad = fix.elevation_rad;
  azimuth_noise_.apply(azimuth_rad, since_fix_s_, random);
  elevation_noise_.apply(elevation_rad, since_fix_s_, random);
  const double across_rad = azimuth_rad - fix.azimuth_rad, up_rad = elevation_rad - fix.elevation_rad;
  if (across_rad != 0 || up_rad != 0) fix.point_at(turned(fix.azimuth_rad, fix.elevation_rad, across_rad, up_rad));
}

void Usbl::visit_state(sim::StateArchive& archive) {
  archive(interrogator_, next_ping_, fixes_, since_fix_s_, range_noise_, azimuth_noise_, elevation_noise_);
}

void UsblReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  for (const Usbl::Fix& fix : usbl_.fixes()) {
    const sim::Vector3d position_S = fix.position_S();
    shoal::usbl_t message{};
    message.utime = out.utime(sampled_at);
    message.target = fix.target;
    message.travel_time_s = fix.travel_time_s;
    message.range_m = fix.range_m;
    message.azimuth_rad = fix.azimuth_rad;
    message.elevation_rad = fix.elevation_rad;
    for (int i = 0; i < 3; ++i) message.position_m[i] = position_S[i];
    shoal::encode_into(message, out.buffer());
    out.publish(out.buffer());
  }
}

SHOAL_SENSOR("usbl", Usbl, UsblReporter);

}  // namespace devices
