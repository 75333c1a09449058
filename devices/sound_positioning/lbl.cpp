// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/lbl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/lbl_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

constexpr double no_answer = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void Lbl::Params::read(sim::ParamReader& in) {
  interrogator.read(in);
  in.read("ping_period_s", ping_period_s, sim::between(0.01, 1e4), "between two pings, at least");
  in.read("assumed_sound_speed_mps", assumed_sound_speed_mps, sim::between(100, 10000),
          "speed of sound that converts times to ranges; unset: the true one at the sensor");
  in.read("assumed_water", assumed_water,
          "water that the user assumes: ranges are those of first arrivals through it; unset: straight lines");
  in.read("answer_dropout", answer_dropout, sim::between(0, 1),
          "probability that an answer is missed, drawn for each answer");
  in.read("time_noise", time_noise, "error of each two-way travel time, s");
}

Lbl::Lbl(const Params& params, const sim::DeviceContext& context)
    : params_(params), interrogator_(params.interrogator, context), time_noise_(context, params) {
  warn_of_assumed_water(params_.assumed_water, context);
  assume();
}

void Lbl::change(const Params& params) {
  params_ = params;
  interrogator_.change(params.interrogator);
  assume();
}

void Lbl::assume() {
  assumed_.reset();
  if (params_.assumed_water) assumed_.emplace(*params_.assumed_water);
}

void Lbl::measure(const sim::SenseContext& context) {
  ranges_.clear();
  const sim::Medium& medium = context.world.medium();
  const sim::Vector3d& p_WS = context.X_WS.translation();
  assumed_mps_ = params_.assumed_sound_speed_mps.value_or(medium.sound_speed_mps(p_WS));
  R_WS_ = context.X_WS.linear();
  depth_m_ = medium.depth_m(p_WS);
  if (asking_ && interrogator_.done(context.now)) collect();
  if (asking_ || context.now < next_ping_ || !medium.in_water(p_WS)) return;
  next_ping_ = context.now + sim::from_seconds(params_.ping_period_s);
  interrogator_.ping(context.now);
  asking_ = true;
}

void Lbl::collect() {
  asking_ = false;
  for (const std::string& name : interrogator_.requested()) ranges_.push_back({name, no_answer, no_answer, 0});
  for (const Interrogator::Answer& answer : interrogator_.take_answers()) {
    const auto range = std::find_if(ranges_.begin(), ranges_.end(),
                                    [&](const Range& each) { return each.transponder == answer.transponder; });
    if (range != ranges_.end())
      *range = {answer.transponder, answer.two_way_s, answer.distance_m, depth_m_ - (R_WS_ * answer.p_ST_S).z()};
  }
}

void Lbl::disturb(double dt_s, sim::Random& random) {
  since_ping_s_ += dt_s;
  for (Range& range : ranges_) {
    if (std::isnan(range.travel_time_s)) continue;
    if (params_.answer_dropout > 0 && random.uniform() < params_.answer_dropout) {
      range.travel_time_s = range.range_m = no_answer;
      continue;
    }
    // Time passes once for all answers of a ping: slow errors advance at the first, and stay for the others.
    time_noise_.apply(range.travel_time_s, since_ping_s_, random);
    since_ping_s_ = 0;
    range.travel_time_s = std::max(range.travel_time_s, 0.0);
    const double one_way_s = range.travel_time_s / 2;
    range.range_m = assumed_ ? assumed_->distance_m(depth_m_, range.depth_m, one_way_s) : one_way_s * assumed_mps_;
  }
}

std::string_view Lbl::lacks() const {
  const bool answered =
      std::any_of(ranges_.begin(), ranges_.end(), [](const Range& range) { return !std::isnan(range.travel_time_s); });
  return answered ? "" : "answer of a transponder";
}

void Lbl::visit_state(sim::StateArchive& archive) {
  archive(interrogator_, asking_, next_ping_, ranges_, since_ping_s_, time_noise_);
}

// Publishes one shoal.lbl_t for each ping.
bool fill(const Lbl& lbl, shoal::lbl_t& message) {
  if (lbl.ranges().empty()) return false;
  message.n = static_cast<std::int32_t>(lbl.ranges().size());
  for (const Lbl::Range& range : lbl.ranges()) {
    message.transponder.push_back(range.transponder);
    message.travel_time_s.push_back(range.travel_time_s);
    message.range_m.push_back(range.range_m);
  }
  return true;
}

SHOAL_SENSOR("lbl", Lbl, shoal::lbl_t);

}  // namespace devices
