// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/version.hpp"

namespace experiment {

std::string short_version() {
  return std::string(SHOAL_VERSION) + " (" + SHOAL_GIT_HASH + ")";
}

}  // namespace experiment
