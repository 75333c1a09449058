// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace sim {

/// Something that cannot be done to the world as it is now.  what() is one line with who, rule and value.
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sim
