// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_profile.hpp"

namespace experiment {

std::string_view default_drive_profile() {
  return R"(# Profile of `shoal drive` and of the live page; docs/guides/drive.md.
rate_hz: 20   # commands per second
hold_s: 0.2   # stops this long after the last input of the driver
keys:
  hold: space
  centre: x
  next_joint: n
  steps:
    - {key: up, axis: forward, step: 0.25}
    - {key: down, axis: forward, step: -0.25}
    - {key: left, axis: turn, step: 0.25}
    - {key: right, axis: turn, step: -0.25}
    - {key: w, axis: forward, step: 0.25}
    - {key: s, axis: forward, step: -0.25}
    - {key: a, axis: turn, step: 0.25}
    - {key: d, axis: turn, step: -0.25}
    - {key: f, axis: dive, step: 0.25}
    - {key: r, axis: dive, step: -0.25}
    - {key: q, axis: side, step: 0.25}
    - {key: e, axis: side, step: -0.25}
# Codes of linux/input-event-codes.h, as the drivers of most pads with two sticks report them.
gamepad:
  hold: 310        # BTN_TL, the left shoulder button
  next_joint: 311  # BTN_TR
  dead_band: 0.1
  axes:
    - {code: 1, axis: forward, scale: -1}  # left stick, up is negative
    - {code: 0, axis: side, scale: -1}
    - {code: 3, axis: turn, scale: -1}     # right stick, right is positive
    - {code: 4, axis: dive, scale: 1}
twist: {forward_mps: 1, turn_radps: 1, steering_deg: 28}
tilt: {tilt_deg: 4, turn_radps: 1}
helm: {speed_mps: 1.5, heading_lead_deg: 45, depth_lead_m: 2}
thrust: {thrust: 1, rudder: 1, elevator: 1}
camera: {pan_degps: 60, tilt_degps: 40, zoom_degps: 15}
joints: {velocity: 0.5}
# Actuators without a drive.  Gains in the unit of each device: command at full deflection.
crafts:
  - name: otter
    devices:
      - {device: port, forward: 60, turn: -40}
      - {device: starboard, forward: 60, turn: 40}
  - name: remus100
    devices:
      - {device: propeller, forward: 1525}
      - {device: rudder, turn: -0.35}
      - {device: stern_planes, dive: 0.35}
  - name: remus_prestero
    devices:
      - {device: thrust, part: force_x_N, forward: 10}
      - {device: rudder, turn: 0.23}
      - {device: stern_planes, dive: 0.23}
  - name: glider
    devices:
      - {device: engine, dive: -2.5e-4}
      - {device: battery, dive: 0.05}
      - {device: rudder, turn: -0.6}
  # The frame of its wrench is forward, starboard, down.
  - name: bluerov2
    devices:
      - {device: wrench, part: force_x_N, forward: 40}
      - {device: wrench, part: force_y_N, side: -40}
      - {device: wrench, part: force_z_N, dive: 40}
      - {device: wrench, part: torque_z_Nm, turn: -5}
programs:
  - {name: balance, devices: [left_motor, right_motor, inclinometer, encoder], tilts: true}
)";
}

}  // namespace experiment
