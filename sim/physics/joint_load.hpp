// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include "sim/physics/joint.hpp"

namespace sim {

/// Load of a joint; internal to the sources of joints.
struct Joint::Load {
  dJointFeedback feedback = {};
  dJointFeedback motor_feedback = {};    // of a ball's motor
  dJointFeedback leaving_feedback = {};  // of stops that motors leave
  dJointFeedback damping_feedback = {};
  // Values at the start of the step, since the load acts at those poses.
  Vector3d p_CA_W = Vector3d::Zero();  // from the center of mass of the loaded body to the anchor
  Vector3d p_AM_W = Vector3d::Zero();  // to the point where ODE applies the added force of a slider
  Vector3d axis_W[max_axes] = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  double added[max_axes] = {};   // by add_effort
  double beside[max_axes] = {};  // outside the solver's rows: added effort, and a motor at a stop
  Vector3d force_W_N = Vector3d::Zero();
  Vector3d torque_W_Nm = Vector3d::Zero();
  double effort[max_axes] = {};
};

}  // namespace sim
