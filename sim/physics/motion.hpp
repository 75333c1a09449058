// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

/// How a body moves.
enum class Motion {
  free,       ///< by forces
  fixed,      ///< not at all, except by Body::set_pose; no mass, no ODE body
  kinematic,  ///< as Body::move_to says; pushes others and is not pushed
};

}  // namespace sim
