// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion/gait/gait_family.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace motion {

/// Gaits with the keys of a motion file that loops: the numbers are the times between its keys, and the value of each
/// joint in each key.  The search starts at the file.  The end of a loop keeps the values of its start.
class FreeKeys final : public GaitFamily {
 public:
  /// Throws ConfigError when the motion does not loop, has no keys or too many, or names a joint that the vehicle has
  /// not.
  FreeKeys(sim::JointMotion motion, const sim::VehicleConfig& vehicle);
  const std::vector<GaitNumber>& numbers() const override { return numbers_; }
  /// The motion after mended(): where a servo would be too slow, the keys are further apart.
  sim::JointMotion motion(std::span<const double> values) const override;

 private:
  /// Value of a key that a number is.
  struct Value {
    std::size_t key = 0, joint = 0;  ///< joint: in `joints` of the key
  };

  void add_values();

  sim::JointMotion motion_;
  sim::VehicleConfig vehicle_;
  std::vector<GaitNumber> numbers_;
  std::vector<Value> values_;                   ///< after the times
  std::vector<std::pair<Value, Value>> equal_;  ///< second is that of the first: the seam of the loop
};

}  // namespace motion
