// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace sim {

/// Failure of an operation that the present state of the world does not allow.  what() is one line with who, rule and
/// value.
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sim
