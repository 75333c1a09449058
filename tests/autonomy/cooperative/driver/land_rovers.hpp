// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/cooperative/driver/land_team.hpp"

namespace land_rovers {

/// Two rovers; the first is at (10, 20) and faces north, with a sensor 0.2 m ahead that looks to the left.
inline navigation::NavTeam rovers() {
  return navigation::land_team_of(navigation::world_of_text(R"(
shoal: 1
name: yard
vehicles:
  - name: rover1
    position_m: [10, 20, 0]
    rpy_deg: [0, 0, 90]
    model: &rover
      shoal: 1
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.5, 0.3, 0.1], mass_kg: 10, position_m: [0, 0, 0.2]}]}
        - {name: l, position_m: [0, 0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}
        - {name: r, position_m: [0, -0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}
      joints:
        - {name: left, type: hinge, bodies: [base, l], axis: [0, 1, 0]}
        - {name: right, type: hinge, bodies: [base, r], axis: [0, 1, 0]}
      devices:
        - {name: wheels, type: odometry, left_joint: left, right_joint: right, rate_hz: 10, noise: {gaussian_std: 0.01}}
        - {name: eye, type: swarm_position, position_m: [0.2, 0, 0], rpy_deg: [0, 0, 90],
           relative_noise: {gaussian_std: 0.1}}
        - {name: gps, type: gps, position_m: [0.3, 0, 0],
           horizontal_noise: {gaussian_std: 0.5, gauss_markov_std: 2, gauss_markov_time_s: 60}}
        - {name: radio, type: modem}
  - {name: rover2, model: *rover}
  - name: crate
    model: {shoal: 1, bodies: [{name: box, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}],
            devices: [{name: clock, type: clock}]}
)"));
}

}  // namespace land_rovers
