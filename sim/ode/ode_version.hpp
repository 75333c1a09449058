// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

/// How the ODE in use was built: its version, precision and options, in ODE's words.
const char* ode_configuration();

}  // namespace sim
