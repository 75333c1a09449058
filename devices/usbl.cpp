#include "devices/usbl.hpp"

#include <algorithm>
#include <cmath>

#include "devices/transponder.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/usbl_t.hpp"
#include "sim/acoustics/sound_path.hpp"

namespace devices {

void Usbl::Params::read(sim::ParamReader& in) {
  in.read("network", network, "transponders of this network answer");
  in.read("ping_period_s", ping_period_s, sim::between(0.01, 1e4), "between two pings, at least");
  in.read("range_max_m", range_max_m, sim::above_to(0, 20000), "transponders farther away are not heard");
  in.read("assumed_sound_speed_mps", assumed_sound_speed_mps, sim::between(100, 10000),
          "that turns times into ranges; unset: the true one at the sensor");
  in.read("occlusion", occlusion, "parts of the world hide transponders");
  in.read("answer_dropout", answer_dropout, sim::between(0, 1), "probability that an answer is missed, for each anew");
  in.read("range_noise", range_noise, "error of each range, m");
  in.read("azimuth_noise", azimuth_noise, "error of each azimuth, rad");
  in.read("elevation_noise", elevation_noise, "error of each elevation, rad");
}

Usbl::Usbl(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      network_(context.world.shared<TransponderNetwork>()),
      full_name_(context.full_name()),
      range_noise_(context.noise(params.range_noise, 1, "range_noise")),
      azimuth_noise_(context.noise(params.azimuth_noise, 1, "azimuth_noise")),
      elevation_noise_(context.noise(params.elevation_noise, 1, "elevation_noise")) {}

void Usbl::change(const Params& params) {
  params_ = params;
  range_noise_.change(params.range_noise);
  azimuth_noise_.change(params.azimuth_noise);
  elevation_noise_.change(params.elevation_noise);
}

sim::Vector3d Usbl::Fix::position_S() const {
  const double across_m = range_m * std::cos(elevation_rad);
  return {across_m * std::cos(azimuth_rad), across_m * std::sin(azimuth_rad), range_m * std::sin(elevation_rad)};
}

void Usbl::measure(const sim::SenseContext& context) {
  fixes_.clear();
  if (!context.world.medium().in_water(context.X_WS.translation())) {
    answers_.clear();  // nothing is heard in air
    return;
  }
  hear(context);
  if (answers_.empty() && context.now >= next_ping_) ping(context);
}

bool Usbl::hidden(const sim::SenseContext& context, const Transponder& target) const {
  const sim::Vector3d way_W = target.p_WS() - context.X_WS.translation();
  const double range_m = way_W.norm();
  if (!params_.occlusion || range_m < 1e-9) return false;
  sim::RayFilter filter;
  filter.kind = sim::RayKind::sound;
  filter.exclude_group = context.vehicle.group();
  const auto hit = context.world.scene().cast(context.X_WS.translation(), way_W / range_m, range_m, filter);
  return hit && context.world.physics().parts()[static_cast<std::size_t>(hit->part)].group != target.group();
}

void Usbl::ping(const sim::SenseContext& context) {
  next_ping_ = context.now + sim::from_seconds(params_.ping_period_s);
  const sim::Vector3d& p_WS = context.X_WS.translation();
  for (Transponder* target : network_.members()) {
    const sim::Vector3d p_WT = target->p_WS();
    const double out_m = (p_WT - p_WS).norm();
    if (out_m > params_.range_max_m || !target->hears(context.vehicle, params_.network)) continue;
    if (hidden(context, *target)) continue;
    target->answer(full_name_);
    const double out_s = travel_time_s(context.world.medium(), p_WS, p_WT);
    const sim::Time due = context.now + sim::from_seconds(2 * out_s + target->params().turnaround_s);
    answers_.push_back({target->full_name(), due, out_s, out_m, p_WT});
  }
}

void Usbl::hear(const sim::SenseContext& context) {
  const sim::Medium& medium = context.world.medium();
  const sim::Vector3d& p_WS = context.X_WS.translation();
  for (const Answer& answer : answers_) {
    if (answer.due > context.now) continue;
    const sim::Vector3d p_ST_S = context.X_WS.inverse() * answer.from_W;
    Fix fix;
    fix.target = answer.target;
    fix.travel_time_s = answer.out_s + travel_time_s(medium, p_WS, answer.from_W);
    fix.range_m = (answer.out_m + p_ST_S.norm()) / 2;
    fix.azimuth_rad = std::atan2(p_ST_S.y(), p_ST_S.x());
    fix.elevation_rad = std::atan2(p_ST_S.z(), std::hypot(p_ST_S.x(), p_ST_S.y()));
    fixes_.push_back(std::move(fix));
  }
  assumed_mps_ = params_.assumed_sound_speed_mps.value_or(medium.sound_speed_mps(p_WS));
  std::erase_if(answers_, [&](const Answer& answer) { return answer.due <= context.now; });
}

void Usbl::disturb(double dt_s, sim::Random& random) {
  since_fix_s_ += dt_s;
  for (Fix& fix : fixes_) {
    fix.range_m = fix.travel_time_s / 2 * assumed_mps_;
    range_noise_.apply(fix.range_m, since_fix_s_, random);
    azimuth_noise_.apply(fix.azimuth_rad, since_fix_s_, random);
    elevation_noise_.apply(fix.elevation_rad, since_fix_s_, random);
    fix.range_m = std::max(fix.range_m, 0.0);
    fix.azimuth_rad = sim::wrap_angle(fix.azimuth_rad);
    since_fix_s_ = 0;
  }
  if (params_.answer_dropout > 0)
    std::erase_if(fixes_, [&](const Fix&) { return random.uniform() < params_.answer_dropout; });
}

void Usbl::hash_state(sim::StateHash& hash) const {
  hash.add(static_cast<std::int64_t>(next_ping_.count()));
  hash.add(since_fix_s_);
  for (const Answer& answer : answers_) {
    hash.add(std::string_view(answer.target));
    hash.add(static_cast<std::int64_t>(answer.due.count()));
    hash.add(answer.out_s);
    hash.add(answer.from_W);
  }
  for (const Fix& fix : fixes_) {
    hash.add(std::string_view(fix.target));
    for (const double number : {fix.travel_time_s, fix.range_m, fix.azimuth_rad, fix.elevation_rad}) hash.add(number);
  }
  for (const sim::Noise* noise : {&range_noise_, &azimuth_noise_, &elevation_noise_}) noise->hash_state(hash);
}

void UsblReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  for (const Usbl::Fix& fix : usbl_.fixes()) {
    const sim::Vector3d position_S = fix.position_S();
    shoal::usbl_t message;
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
