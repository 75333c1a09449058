// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/ball_chase.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace autonomy {

namespace {

/// Longest latency of an image that is corrected.
constexpr std::int64_t max_late_us = 1'000'000;

}  // namespace

BallChase::BallChase(const Params& params) : params_(params) {
  for (const double number : {params.search_turn_radps, params.turn_gain_per_s, params.max_turn_radps,
                              params.slow_bearing_rad, params.kick_range_m, params.kick_s, params.lost_s})
    if (!(number > 0)) throw std::invalid_argument("gains, ranges and times must be above 0");
}

void BallChase::see(const std::optional<BallSighting>& sighting) {
  is_visible_ = sighting.has_value();
  if (!sighting) return;
  is_new_ = true;
  ball_ = sighting;
}

void BallChase::enter(Phase phase, std::int64_t utime) {
  if (phase == phase_) return;
  phase_ = phase;
  phase_utime_ = utime;
  if (phase == Phase::kick) ++kicks_;
}

ChaseCommand BallChase::search(double in_phase_s) const {
  const double turn_s = 2 * std::numbers::pi / params_.search_turn_radps;
  if (std::fmod(in_phase_s, turn_s + params_.back_s) > turn_s) return {params_.back_mps, 0};
  const bool to_the_right = ball_ && ball_->bearing_rad < 0;
  return {0, to_the_right ? -params_.search_turn_radps : params_.search_turn_radps};
}

/// Drives towards the ball while it is visible, else straight on.
ChaseCommand BallChase::follow(double forward_mps) const {
  if (!is_visible_) return {forward_mps, 0};
  const double turn = params_.turn_gain_per_s * bearing_rad_;
  return {forward_mps, std::clamp(turn, -params_.max_turn_radps, params_.max_turn_radps)};
}

double BallChase::turned_rad(std::int64_t utime) const {
  double angle_rad = 0;
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    const std::int64_t from = std::max(turns_[i].utime, ball_->utime);
    const std::int64_t to = i + 1 < turns_.size() ? turns_[i + 1].utime : utime;
    if (to > from) angle_rad += turns_[i].radps * static_cast<double>(to - from) * 1e-6;
  }
  return angle_rad;
}

ChaseCommand BallChase::step(std::int64_t utime) {
  if (ball_) bearing_rad_ = ball_->bearing_rad - (params_.predict ? turned_rad(utime) : 0);
  const ChaseCommand command = decide(utime);
  turns_.push_back({utime, command.turn_radps});
  while (turns_.front().utime < utime - max_late_us) turns_.pop_front();
  return command;
}

ChaseCommand BallChase::decide(std::int64_t utime) {
  if (!phase_utime_) phase_utime_ = utime;
  const auto since_s = [utime](std::int64_t then) { return static_cast<double>(utime - then) * 1e-6; };
  const Params& p = params_;

  // Transitions.
  if (is_new_) {
    const bool in_reach = ball_->range_m < p.kick_range_m;
    seen_utime_ = utime;
    if (in_reach) in_reach_utime_ = utime;
    if (phase_ == Phase::search) enter(Phase::approach, utime);
    if (phase_ == Phase::approach && may_kick_ && in_reach && std::abs(bearing_rad_) < p.kick_bearing_rad)
      enter(Phase::kick, utime);
  }
  is_new_ = false;
  if (phase_ == Phase::approach && since_s(seen_utime_) > p.lost_s) enter(Phase::search, utime);
  if (phase_ == Phase::kick && since_s(in_reach_utime_) > p.kick_s)
    enter(since_s(seen_utime_) > p.lost_s ? Phase::search : Phase::approach, utime);

  // Command.
  switch (phase_) {
    case Phase::search:
      return search(since_s(*phase_utime_));
    case Phase::approach: {
      const double ahead = std::clamp(1 - std::abs(bearing_rad_) / p.slow_bearing_rad, 0.0, 1.0);
      return follow(ahead * p.approach_mps);
    }
    case Phase::kick:
      break;
  }
  return follow(p.kick_mps);
}

}  // namespace autonomy
