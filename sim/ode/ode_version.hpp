// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

/// Returns the version, precision and build options of the ODE library in use, in ODE's format.
const char* ode_configuration();

}  // namespace sim
