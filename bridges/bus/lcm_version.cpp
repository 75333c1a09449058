// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/lcm_version.hpp"

#include <lcm/lcm.h>

namespace bridges {

std::string lcm_version() {
  return std::to_string(LCM_MAJOR_VERSION) + "." + std::to_string(LCM_MINOR_VERSION) + "." +
         std::to_string(LCM_MICRO_VERSION);
}

}  // namespace bridges
