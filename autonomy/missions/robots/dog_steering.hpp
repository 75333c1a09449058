// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "autonomy/missions/robots/ball_chase.hpp"

namespace autonomy {

/// Set points of the two joints by which the head of an ERS-7 looks down, rad; positive is up.
struct HeadPose {
  double neck_tilt_rad = 0, head_nod_rad = 0;
};

/// Steers a robot dog that walks by motions which loop, and whose head follows the ball up and down.  Independent of
/// clock and bus.
class DogSteering {
 public:
  struct Params {
    double curve_radps = 0.2;       ///< from this turn rate on it walks in a curve
    double spot_radps = 0.5;        ///< from this one on it turns on the spot
    double hold_s = 0.3;            ///< a motion is kept at least this long
    double search_down_rad = 0.15;  ///< pitch of the head in the search, positive down
    double max_down_rad = 1;
    double follow_gain = 0.3;   ///< share of the elevation of the ball that an image corrects
    double max_nod_rad = 0.25;  ///< the head nods this far down, the neck does the rest
  };

  explicit DogSteering(const Params& params) : params_(params), down_rad_(params.search_down_rad) {}
  /// Takes a sighting in the frame of the camera.  Returns it in a level frame with the heading of the camera.
  BallSighting level(const BallSighting& sighting) const;
  /// Moves the head so that the ball of the last image is in the middle; none: back to that of the search.
  HeadPose look(const std::optional<BallSighting>& sighting);
  /// Returns the motion to start at the tick `utime`; none: the present one continues.  In a kick it walks straight by
  /// the motion `kick`, a faster trot.
  std::optional<std::string> walk(std::int64_t utime, const ChaseCommand& command, bool is_kick);

  double down_rad() const { return down_rad_; }

 private:
  Params params_;
  double down_rad_;  ///< pitch of the head
  std::string motion_;
  std::int64_t changed_utime_ = 0;
};

}  // namespace autonomy
