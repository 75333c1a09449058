// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/gait_family.hpp"

#include <stdexcept>

#include "motion/gait/cpg.hpp"
#include "motion/gait/half_ellipse.hpp"
#include "motion/gait/skelliptical.hpp"

namespace motion {

const std::vector<std::string>& gait_names() {
  static const std::vector<std::string> names{"half_ellipse", "skelliptical", "cpg"};
  return names;
}

std::unique_ptr<GaitFamily> make_gait(const std::string& name, const sim::VehicleConfig& vehicle) {
  if (name == "half_ellipse") return std::make_unique<HalfEllipse>(vehicle);
  if (name == "skelliptical") return std::make_unique<Skelliptical>(vehicle);
  if (name == "cpg") return std::make_unique<Cpg>(vehicle);
  throw std::out_of_range("unknown gait '" + name + "'");
}

}  // namespace motion
