// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace motion {

/// Number that describes a gait, with its range and where a search starts.
struct GaitNumber {
  std::string name;  ///< with its unit
  double low = 0, start = 0, high = 1;
};

/// Gaits of one kind, each described by a few numbers.
class GaitFamily {
 public:
  virtual ~GaitFamily() = default;
  virtual const std::vector<GaitNumber>& numbers() const = 0;
  /// Returns the gait as a motion that loops, within the ranges and speeds of the servos.
  virtual sim::JointMotion motion(std::span<const double> values) const = 0;
};

/// Names of the families.
const std::vector<std::string>& gait_names();

/// Makes a family for a vehicle.  Throws ConfigError when the vehicle has not the legs for it, std::out_of_range for an
/// unknown name.
std::unique_ptr<GaitFamily> make_gait(const std::string& name, const sim::VehicleConfig& vehicle);

}  // namespace motion
