// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include "sim/physics/joint.hpp"

namespace sim {

/// Load of a joint, internal to the sources of joints.
struct Joint::Load {
  dJointFeedback feedback = {};
  dJointFeedback motor_feedback = {};  // of a ball's motor
  // At the start of the step: the load acts at the poses that the bodies have then.
  Vector3d p_CA_W = Vector3d::Zero();  // from the centre of mass of the loaded body to the anchor
  Vector3d p_AM_W = Vector3d::Zero();  // to where ODE lets the added force of a slider act
  Vector3d axis_W[max_axes] = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  double added[max_axes] = {};   // by add_effort
  double beside[max_axes] = {};  // not by the solver's rows: added, and a motor at a stop
  Vector3d force_W_N = Vector3d::Zero();
  Vector3d torque_W_Nm = Vector3d::Zero();
  double effort[max_axes] = {};
};

}  // namespace sim
