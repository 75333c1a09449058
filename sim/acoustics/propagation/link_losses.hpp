// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/decibels.hpp"

namespace sim {

/// Losses from one transducer to another by `links:` of the world.
struct LinkLosses {
  Decibels loss{0};
  double probability = 0;  ///< that any of the random losses occurs
};

/// Returns the losses from a source to a receiver, both such as `auv1/modem`.
LinkLosses link_losses(std::span<const LinkConfig> links, const std::string& source, const std::string& receiver);

}  // namespace sim
