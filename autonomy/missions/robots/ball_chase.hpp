// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "autonomy/vision/ball_detector.hpp"

namespace autonomy {

/// Speed and turn rate that the chase asks for.
struct ChaseCommand {
  double forward_mps = 0;
  double turn_radps = 0;  ///< counter-clockwise
};

/// Finds a ball, drives to it and kicks it, by what one camera sees: a pure function of sightings and ticks in their
/// order, independent of clock and bus.
///
///   - search: it turns on the spot, towards the side where the ball was last; after a whole turn it drives backwards
///     for a while, since a ball below the camera is not in the image.
///   - approach: turn rate proportional to the bearing; the larger the bearing, the slower.
///   - kick: near and straight ahead, it drives as fast as it can, also when the ball is below the camera.
///
/// Images are late.  With `predict` their time stamps are used: since then the vehicle has turned as commanded.
class BallChase {
 public:
  enum class Phase { search, approach, kick };
  struct Params {
    double search_turn_radps = 1;
    double turn_gain_per_s = 5;  ///< turn rate per bearing
    double max_turn_radps = 2;
    double approach_mps = 1.2;
    double slow_bearing_rad = 0.6;  ///< bearing from which on it only turns
    double kick_mps = 1.8;
    double kick_range_m = 1.2;
    double kick_bearing_rad = 0.15;  ///< a kick starts at a smaller bearing
    double kick_s = 1.5;             ///< a kick ends this long after the last sighting within its range
    double lost_s = 0.5;             ///< without a sighting for this long it searches
    double back_s = 1.5;
    double back_mps = -0.4;
    bool predict = false;  ///< the bearing of a late image is corrected by the turns since its time
  };

  /// Throws std::invalid_argument for gains and times that are not above 0.
  explicit BallChase(const Params& params);
  /// Takes the result of an image; none: there was no ball in it.
  void see(const std::optional<BallSighting>& sighting);
  /// Whether a kick may start; at first it may.
  void allow_kick(bool allowed) { may_kick_ = allowed; }
  /// Decides at the tick `utime`.
  ChaseCommand step(std::int64_t utime);

  Phase phase() const { return phase_; }
  /// The last sighting, which may be old.
  const std::optional<BallSighting>& ball() const { return ball_; }
  /// Number of kicks that were started.
  int kicks() const { return kicks_; }

 private:
  void enter(Phase phase, std::int64_t utime);
  ChaseCommand search(double in_phase_s) const;
  ChaseCommand follow(double forward_mps) const;
  ChaseCommand decide(std::int64_t utime);
  /// Returns the angle by which it was asked to turn from the time of the last image to `utime`.
  double turned_rad(std::int64_t utime) const;

  Params params_;
  Phase phase_ = Phase::search;
  std::optional<std::int64_t> phase_utime_ = {};  ///< start of the phase; none before the first tick
  std::optional<BallSighting> ball_ = {};
  bool is_visible_ = false;          ///< in the last image
  bool is_new_ = false;              ///< seen since the last tick
  std::int64_t seen_utime_ = 0;      ///< tick of the last sighting
  std::int64_t in_reach_utime_ = 0;  ///< tick of the last sighting within the range of a kick
  int kicks_ = 0;
  bool may_kick_ = true;
  double bearing_rad_ = 0;  ///< of the ball at the present tick
  struct Turn {
    std::int64_t utime;
    double radps;
  };
  std::deque<Turn> turns_ = {};  ///< those of the last second, each until the next one
};

}  // namespace autonomy
