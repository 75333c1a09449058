// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/dog_steering.hpp"

#include <algorithm>
#include <cmath>

namespace autonomy {

BallSighting DogSteering::level(const BallSighting& sighting) const {
  // The direction of the ball, turned by the pitch of the head.
  const double ahead = std::cos(sighting.elevation_rad) * std::cos(sighting.bearing_rad);
  const double left = std::cos(sighting.elevation_rad) * std::sin(sighting.bearing_rad);
  const double up = std::sin(sighting.elevation_rad);
  const double level_ahead = ahead * std::cos(down_rad_) + up * std::sin(down_rad_);
  const double level_up = up * std::cos(down_rad_) - ahead * std::sin(down_rad_);
  BallSighting turned = sighting;
  turned.bearing_rad = std::atan2(left, level_ahead);
  turned.elevation_rad = std::atan2(level_up, std::hypot(level_ahead, left));
  return turned;
}

HeadPose DogSteering::look(const std::optional<BallSighting>& sighting) {
  const double error_rad = sighting ? -sighting->elevation_rad : params_.search_down_rad - down_rad_;
  down_rad_ = std::clamp(down_rad_ + params_.follow_gain * error_rad, -params_.max_nod_rad, params_.max_down_rad);
  const double nod_down_rad = std::min(down_rad_, params_.max_nod_rad);
  return {nod_down_rad - down_rad_, -nod_down_rad};
}

std::optional<std::string> DogSteering::walk(std::int64_t utime, const ChaseCommand& command, bool is_kick) {
  const char* side = command.turn_radps > 0 ? "left" : "right";
  const double rate_radps = std::abs(command.turn_radps);
  std::string motion = is_kick ? "kick" : "trot";
  if (rate_radps >= params_.spot_radps)
    motion = std::string("turn_") + side;
  else if (rate_radps >= params_.curve_radps)
    motion = std::string("trot_") + side;
  if (motion == motion_) return std::nullopt;
  if (!motion_.empty() && static_cast<double>(utime - changed_utime_) * 1e-6 < params_.hold_s) return std::nullopt;
  motion_ = motion;
  changed_utime_ = utime;
  return motion;
}

}  // namespace autonomy
