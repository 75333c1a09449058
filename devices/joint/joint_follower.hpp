// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Linkage that keeps one axis of a joint at multiplier * position + offset of another one, such as the second finger
/// of a gripper (`<mimic>` of URDF).  In each step it runs at the velocity that removes the error and follows the
/// present velocity of the other joint, so that it lags by multiplier * acceleration * step^2.  The other joint does
/// not feel it.  It has no electronics: it works without power and at an emergency stop.
class JointFollower final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Linkage that keeps one axis of a joint at a multiple of another one's position.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr const char* fixed_keys[] = {"joint", "axis", "follows", "follows_axis"};
  static constexpr bool always_on = true;
  struct Params {
    std::string joint, follows;
    int axis = 0, follows_axis = 0;
    double multiplier = 1;
    double offset = 0;                   ///< rad or m
    double max_effort = 10;              ///< N m or N
    std::optional<double> max_velocity;  ///< rad/s or m/s
    void read(sim::ParamReader& in);
  };

  JointFollower(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  void make_safe(sim::SafeState) override {}  // a linkage has none
  void change(const Params& params) { params_ = params; }
  void visit_state(sim::StateArchive&) override {}

 private:
  Params params_;
  sim::Joint& joint_;
  const sim::Joint& followed_;
};

}  // namespace devices
