// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// Target of an action: a vehicle or object by name, or `one_of` several.
struct TargetChoice {
  std::vector<std::string> names;

  /// Reads the target.  `key`: key of the name.
  void read(ParamReader& in, const char* key);
  /// Returns the name of the target; draws from `random` when there are several.
  const std::string& choose(Random& random) const;
};

}  // namespace sim
