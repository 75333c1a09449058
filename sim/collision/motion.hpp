// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

/// How a body moves.
enum class Motion {
  free,       ///< moves by forces
  fixed,      ///< does not move, except by Body::set_pose; no mass, no ODE body
  kinematic,  ///< as prescribed by Body::move_to; pushes other bodies and is not pushed
};

}  // namespace sim
