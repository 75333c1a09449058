// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace sim {

/// Error of the physics: the state of a body is NaN or out of bounds, or ODE failed.  The world cannot be stepped
/// further.
class PhysicsFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sim
