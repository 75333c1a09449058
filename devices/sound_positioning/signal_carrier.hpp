// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/medium/medium.hpp"

namespace devices {

/// Carrier of a signal between devices, which determines the media it passes through.
enum class SignalCarrier {
  radio,     ///< does not pass through water
  acoustic,  ///< does not pass through air; blocked in a world without water
  any,       ///< passes through everything
};

/// Reads the key `through`.
void read_through(sim::ParamReader& in, SignalCarrier& through);

/// Returns whether an antenna or transducer works at this position.
bool carries(const sim::Medium& medium, SignalCarrier carrier, const sim::Vector3d& p_W);

}  // namespace devices
