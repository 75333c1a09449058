#include <lcm/lcm.h>

#include <ode/ode.h>
#include <spdlog/fmt/fmt.h>

#include "tools/experiment/runner.hpp"

namespace tools {

std::string version_text() {
  return fmt::format(
      "shoal {} ({})\n"
      "ODE: {}\n"
      "LCM {}.{}.{}, Eigen {}.{}.{}, fmt {}\n"
      "compiler: {}\n",
      SHOAL_VERSION, SHOAL_GIT_HASH, dGetConfiguration(), LCM_MAJOR_VERSION, LCM_MINOR_VERSION, LCM_MICRO_VERSION,
      EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, FMT_VERSION, __VERSION__);
}

}  // namespace tools
