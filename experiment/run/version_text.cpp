// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>

#include "bridges/bus/lcm_bus.hpp"
#include "experiment/run/version.hpp"
#include "sim/ode/ode_version.hpp"

namespace experiment {

std::string version_text() {
  return fmt::format(
      "shoal {}\n"
      "ODE: {}\n"
      "LCM {}, Eigen {}.{}.{}, fmt {}\n"
      "compiler: {}\n",
      short_version(), sim::ode_configuration(), bridges::lcm_version(), EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
      EIGEN_MINOR_VERSION, FMT_VERSION, __VERSION__);
}

}  // namespace experiment
