// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "motion/analysis/motion_check.hpp"
#include "motion/gait/half_ellipse.hpp"
#include "motion/gait/leg_motion.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"

namespace ers7_gait {

inline sim::VehicleConfig ers7() {
  return sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"));
}

inline std::vector<double> start_of(const motion::HalfEllipse& gait) {
  std::vector<double> values;
  for (const motion::GaitNumber& number : gait.numbers()) values.push_back(number.start);
  return values;
}

}  // namespace ers7_gait
