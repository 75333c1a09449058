#include <ode/ode.h>
#include <spdlog/fmt/fmt.h>

#include "bridges/lcm/lcm_version.hpp"
#include "tools/experiment/runner.hpp"

namespace tools {

std::string version_text() {
  return fmt::format(
      "shoal {} ({})\n"
      "ODE: {}\n"
      "LCM {}, Eigen {}.{}.{}, fmt {}\n"
      "compiler: {}\n",
      SHOAL_VERSION, SHOAL_GIT_HASH, dGetConfiguration(), bridges::lcm_version(), EIGEN_WORLD_VERSION,
      EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, FMT_VERSION, __VERSION__);
}

}  // namespace tools
