// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/medium/medium.hpp"

namespace devices {

/// What carries a signal from device to device, and so what it passes.
enum class SignalCarrier {
  radio,     ///< not water
  acoustic,  ///< not air; where a world has no water it passes nothing
  any,       ///< everything
};

/// The key `through`.
void read_through(sim::ParamReader& in, SignalCarrier& through);

/// An antenna or transducer works at this place.
bool carries(const sim::Medium& medium, SignalCarrier carrier, const sim::Vector3d& p_W);

}  // namespace devices
