// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// Reports unphysical values as errors: inertia that is not positive definite, added mass that is asymmetric or
/// negative, damping that adds energy.  Expects numbers that were read without errors.
void check_coefficients(const HydrodynamicsConfig& config, ParamReader& in);

/// Returns warnings about an inertia that is possible but most likely wrong.
std::vector<std::string> doubts_about_inertia(const HydrodynamicsConfig& config);

/// Returns these, and warnings about coefficients that are possible but most likely wrong.
std::vector<std::string> doubts_about(const HydrodynamicsConfig& config);

}  // namespace sim
