// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/lamp.hpp"

#include <cmath>
#include <numbers>

#include "sim/scene/light.hpp"

namespace sim {

void LampConfig::read(ParamReader& in) {
  in.read("name", name, "for messages");
  in.read("position_m", position_m, any_number(), "on the body of the camera");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch, yaw on the body; x is the axis of the beam");
  in.read("strength", strength, above_to(0, 1e6),
          "light on a surface that faces it at 1 m, as 'sun' of the world's light; it falls with the square of the "
          "distance");
  in.read_deg("beam_deg", beam_rad, between(1, 180), "width of the beam between half of its strength and half");
  in.read("color", color, "color, as in \"#ffe0b0\"");
  if (!in.describing() && !parse_color(color)) in.error("color", "'color' must be in the form \"#rrggbb\"");
}

Lamp LampConfig::lamp(const Pose& X_BS) const {
  Lamp lamp;
  lamp.X_SL = X_BS.inverse() * make_pose(position_m, rpy_rad);
  lamp.color = linear_color(parse_color(color).value_or(Color{255, 255, 255})) * static_cast<float>(strength);
  lamp.spread = static_cast<float>(std::numbers::ln2 / (1 - std::cos(0.5 * beam_rad)));
  return lamp;
}

}  // namespace sim
