// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/terrain/height_grid.hpp"

namespace test {

/// What TerrainError an action throws.
template <typename Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const sim::TerrainError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace test
