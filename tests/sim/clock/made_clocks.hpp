// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/clock/vehicle_clock.hpp"
#include "sim/random/allan.hpp"

namespace made_clocks {

inline constexpr sim::Time hour{3'600'000'000};

inline sim::VehicleClock made(const sim::ClockConfig& config, std::uint64_t seed = 1) {
  return sim::VehicleClock(config, seed, "auv", sim::Time{0});
}

}  // namespace made_clocks
