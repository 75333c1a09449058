// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "motion/analysis/motion_stage.hpp"

namespace motion {

/// How a vehicle is pushed.
struct PushOptions {
  int directions = 8;       ///< horizontal, evenly around; the first one forward
  double push_s = 0.05;     ///< duration
  double watch_s = 2;       ///< time after the push in which it may fall
  double greatest_mps = 6;  ///< greatest impulse over the mass of the vehicle
  double resolution_mps = 1.0 / 64;
  double settle_mps = 0.1875;  ///< impulse over mass of the settle displacement; 0: it is not measured
  int threads = 0;             ///< 0: one for each processor
};

/// Pushes that a vehicle withstands at an instant, while its motion continues.
struct PushMargin {
  double at_s = 0;                    ///< time of the run
  std::vector<double> withstood_mps;  ///< by direction: largest impulse per mass that it withstands
  double mass_kg = 0;
  double settle_m =
      0;  ///< greatest distance from where it is without a push, over pushes of settle_mps in all directions

  /// Returns the impulse that it withstands in the worst direction, N s, and that direction, counter-clockwise from
  /// ahead, rad.
  double least_Ns() const;
  double least_direction_rad() const;
};

/// One push at an instant.
struct Push {
  double at_s = 0;           ///< time of the run
  double direction_rad = 0;  ///< horizontal, counter-clockwise from ahead
  double mps = 0;            ///< impulse over the mass of the vehicle
};

/// Effect of a push.
struct PushOutcome {
  bool fell = false;
  sim::Vector3d end_W = sim::Vector3d::Zero();  ///< position of the first body at the end, m

  /// Returns the horizontal distance to the end of another push, m.
  double distance_m(const PushOutcome& other) const { return (end_W - other.end_W).head<2>().norm(); }
};

/// Pushes copies of the world, once for each push.  Instants, results and the world of the stage as in push_margins().
std::vector<PushOutcome> outcomes_of(MotionStage& stage, const std::vector<Push>& pushes, const PushOptions& options);

/// Pushes copies of the world at each instant, which must increase.  The world of the stage is at the last instant
/// afterwards, and as it would be without the pushes.  Results do not depend on the number of threads.
///
/// A vehicle has fallen when its first body tilts by more than 45 degrees, or touches something that it did not touch
/// before.
std::vector<PushMargin> push_margins(MotionStage& stage, const std::vector<double>& instants_s,
                                     const PushOptions& options);

/// The weakest instant and direction of a motion.
struct WeakestPush {
  bool falls = false;        ///< without a push; the rest is then that instant
  bool is_beyond = false;    ///< it withstands the largest push everywhere
  double withstood_mps = 0;  ///< greatest impulse over mass that it withstands at all instants in all directions
  double at_s = 0;           ///< time of the run
  double direction_rad = 0;  ///< counter-clockwise from ahead
  double mass_kg = 0;
};

/// Returns the smallest margin over all instants and directions, with a small part of the pushes of push_margins():
/// only the pushes that made it fall are repeated with weaker ones, and a push ends when the vehicle moves again as it
/// does without one.  Instants and results as in push_margins(); the world of the stage ends later, when the last push
/// may make it fall.
WeakestPush weakest_push(MotionStage& stage, const std::vector<double>& instants_s, const PushOptions& options);

}  // namespace motion
