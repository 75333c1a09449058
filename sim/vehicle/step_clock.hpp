// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/base/time.hpp"

namespace sim {

/// Time of a world: number of whole steps since its start.
struct StepClock {
  Time step{0};                  ///< length of one step
  std::int64_t step_number = 0;  ///< number of completed physics steps
  Time now() const { return Time{step_number * step.count()}; }
};

}  // namespace sim
