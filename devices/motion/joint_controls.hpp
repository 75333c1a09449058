// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace devices {

/// Keys and sticks that move joints while a motion is recorded.
struct JointControls {
  /// Two keys of a joint.
  struct Key {
    std::string joint, plus, minus;
    std::optional<double> velocity;  ///< unset: that of the controls
    void read(sim::ParamReader& in);
  };
  /// Axis of a gamepad that moves a joint while its set is selected.
  struct Stick {
    std::string set, joint;
    int axis = 0;
    std::optional<double> velocity;  ///< at full deflection; negative: the other way round
    double low = -32768, high = 32767;
    void read(sim::ParamReader& in);
  };

  double velocity = 1;  ///< rad/s, or m/s of a slider
  std::vector<Key> keys;
  std::vector<Stick> sticks;

  void read(sim::ParamReader& in);
};

}  // namespace devices
