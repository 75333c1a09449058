// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/joint_controls.hpp"

namespace devices {

void JointControls::Key::read(sim::ParamReader& in) {
  in.require("joint");
  in.read("joint", joint, "servo, or its alias");
  in.require("plus");
  in.read("plus", plus, "key towards greater positions: a character, or up, down, left, right");
  in.require("minus");
  in.read("minus", minus, "key towards lower positions");
  in.read("velocity", velocity, sim::above_to(0, 1000), "rad/s or m/s; unset: 'velocity' of the controls");
  if (!in.describing() && !plus.empty() && plus == minus) in.error("minus", "'minus' must be another key than 'plus'");
}

void JointControls::Stick::read(sim::ParamReader& in) {
  in.require("joint");
  in.read("joint", joint, "servo, or its alias");
  in.require("axis");
  in.read("axis", axis, sim::between(0, 63), "code of the axis (ABS_ in linux/input-event-codes.h)");
  in.read("set", set, "sticks of one set move joints at the same time; the shoulder buttons select the set");
  in.read("velocity", velocity, sim::between(-1000, 1000),
          "at full deflection, rad/s or m/s; negative: the other way round; unset: 'velocity' of the controls");
  in.read("low", low, sim::between(-1e6, 1e6), "lowest value of the axis, if the device does not report it");
  in.read("high", high, sim::between(-1e6, 1e6), "highest value of the axis, if the device does not report it");
  if (!in.describing() && !(low < high)) in.error("high", "'high' must be above 'low'");
}

void JointControls::read(sim::ParamReader& in) {
  in.read("velocity", velocity, sim::above_to(0, 1000), "of a joint while its key is held, rad/s or m/s");
  in.read_list("keys", keys, "key",
               "keys of joints; unset: in the order of the servos 1 and q, 2 and w ... a and z ...");
  in.read_list("sticks", sticks, "stick",
               "sticks of a gamepad; unset: sets of four joints in the order of the servos, by axes 1, 0, 4 and 3");
  if (in.describing()) return;
  for (const Key& key : keys)
    for (const std::string& name : {key.plus, key.minus})
      if (!name.empty()) in.declare("key", name);
}

}  // namespace devices
