// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// The vehicle or object that something is done to: by name, or `one_of` several.
struct TargetChoice {
  std::vector<std::string> names;

  /// `key`: of the name.
  void read(ParamReader& in, const char* key);
  /// Draws from `random` when there are several.
  const std::string& choose(Random& random) const;
};

}  // namespace sim
