// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/physics/joint.hpp"

namespace sim {

/// Joint as the classes of the step see it.  In a step its damping, and the stops that its motors leave, become joints
/// of the step before the solver; afterwards the load is read from what the solver left, and the position is brought up
/// to date.
class SteppedJoint final : public Joint {
 public:
  /// Attaches the bodies at their present poses.  `second` null: the world.
  SteppedJoint(dxWorld* world, const std::string& name, const JointConfig& config, dxBody* first, dxBody* second,
               const Pose& X_WV)
      : Joint(world, name, config, first, second, X_WV) {}
  using Joint::ode;
  using Joint::origin;
  // Creation, again as well.
  using Joint::create_again;
  using Joint::make_again;
  using Joint::max_rows;
  using Joint::move_world_side;
  // Of a step, in the order of the calls.
  using Joint::end_leaving_stops;
  using Joint::is_measured;
  using Joint::note_before_step;
  using Joint::note_load;
  using Joint::start_damping;
  using Joint::start_leaving_stops;
  using Joint::update_position;
};

}  // namespace sim
