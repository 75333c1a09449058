// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/config/param_reader.hpp"

namespace devices {

/// Key whose value is a factor of the number of rays in a sample.
struct RayFactor {
  std::string key;
  double count;
};

/// Reports an error at one of the keys when a sample needs more than a million rays.
void check_rays(sim::ParamReader& in, std::span<const RayFactor> factors);

/// Returns the rate of the device from its own map; 0: every step.  Errors of the rate are reported elsewhere.
double rate_hz_of(const sim::ParamReader& in, double default_rate_hz);

}  // namespace devices
