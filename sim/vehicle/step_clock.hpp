// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/base/time.hpp"

namespace sim {

/// The time of a world: so many whole steps since its start.
struct StepClock {
  Time step{0};                  ///< length of one
  std::int64_t step_number = 0;  ///< of the last step that physics has done
  Time now() const { return Time{step_number * step.count()}; }
};

}  // namespace sim
