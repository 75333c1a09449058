// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace experiment {

/// Error of a vehicle that cannot be driven as asked, or of a gamepad.
class DriveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace experiment
