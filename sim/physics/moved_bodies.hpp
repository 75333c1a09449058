// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/collision/collider.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/physics/far_groups.hpp"
#include "sim/physics/groups.hpp"
#include "sim/physics/leaps.hpp"

namespace sim {

/// What is looked at when a body was moved, in whichever way: its position, for the collider; its box, for FarGroups;
/// its speed, for Leaps; and the limits of speed and distance, beyond which the simulation has diverged.  This class
/// owns the limits.
///
/// Each thread collects what it saw in its own Batch, and hands it over when it is done with its bodies.  A body
/// beyond a limit does not end the step of the others: when all have moved, throw_first_fault() names the first such
/// body in the order of the groups, so that the message does not depend on the threads.
class MovedBodies {
 public:
  /// Bodies that one thread moved.
  struct Batch {
    std::vector<int> left;  ///< groups of bodies that left their boxes
    std::vector<int> fast;  ///< bodies
    bool out_of_bounds = false;
  };

  MovedBodies(const PhysicsConfig& config, Collider& collider, FarGroups& far_groups, Leaps& leaps)
      : max_speed_mps_(config.max_speed_mps),
        max_distance_m_(config.max_distance_m),
        collider_(collider),
        far_groups_(far_groups),
        leaps_(leaps) {}

  /// Looks at a body.  Threads may do so for different bodies.
  void look_at(const SteppedBody& body, Batch& batch) const {
    collider_.note_position(body.number());
    batch.out_of_bounds |= is_out_of_bounds(body);
    if (body.left_its_box()) batch.left.push_back(body.group());
    if (body.may_leap()) batch.fast.push_back(body.number());
  }
  /// Thread-safe.
  void hand_over(const Batch& batch) const {
    far_groups_.note_left(batch.left);
    leaps_.note_fast(batch.fast);
  }

  bool is_out_of_bounds(const SteppedBody& body) const {
    const auto square = [](const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    // Comparisons with NaN are false, so that NaN is out of bounds.  Angular velocity has no configured bound, but must
    // be finite.
    return !(square(body.v_WC_W()) <= max_speed_mps_ * max_speed_mps_ &&
             square(body.p_WC()) <= max_distance_m_ * max_distance_m_ && square(body.w_WB_W_of_ode()) < 1e300);
  }
  /// Throws PhysicsFault with the name of the first body that is out of bounds, if there is one.
  void throw_first_fault(const Groups& groups, std::int64_t step_number) const;

 private:
  double max_speed_mps_, max_distance_m_;
  Collider& collider_;
  FarGroups& far_groups_;
  Leaps& leaps_;
};

}  // namespace sim
