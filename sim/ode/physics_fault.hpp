// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace sim {

/// A body became NaN or flew off, or ODE gave up.  The world cannot be stepped any further.
class PhysicsFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sim
