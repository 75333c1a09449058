// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/config/param_reader.hpp"

namespace devices {

/// One of the keys whose product is the number of rays in a sample.
struct RayFactor {
  std::string key;
  double count;
};

/// An error at one of the keys when a sample takes more than a million rays.
void check_rays(sim::ParamReader& in, std::span<const RayFactor> factors);

/// The rate that the device will have, from its own map: 0 is every step.  What is wrong with it is said elsewhere.
double rate_hz_of(const sim::ParamReader& in, double default_rate_hz);

}  // namespace devices
