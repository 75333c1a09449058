// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/base/math.hpp"
#include "sim/camera/texture.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Lamp of a camera, in its sensor frame S.  Its light falls with the square of the distance and with the angle to its
/// axis, x of L: by exp(-spread (1 - cos(angle))), the density of von Mises and Fisher.
struct Lamp {
  Pose X_SL = Pose::Identity();
  LinearColor color = LinearColor::Ones();  ///< light on a surface that faces it at 1 m, as LightConfig::sun
  float spread = 1;
};

/// Entry of `lamps:` of a camera.
struct LampConfig {
  std::string name;
  Vector3d position_m = Vector3d::Zero();  ///< in the frame B of the camera's body
  Vector3d rpy_rad = Vector3d::Zero();
  double strength = 2;
  double beam_rad = degrees_to_radians(120);
  std::string color = "#ffffff";

  void read(ParamReader& in);
  /// `X_BS`: pose of the camera on its body.
  Lamp lamp(const Pose& X_BS) const;
};

}  // namespace sim
