// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace bridges {

/// Returns the version of the LCM library, such as `1.3.1`.
std::string lcm_version();

}  // namespace bridges
