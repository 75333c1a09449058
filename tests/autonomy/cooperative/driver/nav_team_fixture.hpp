// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "autonomy/cooperative/driver/nav_team.hpp"

namespace nav_team_fixture {

using namespace navigation;

inline NavTeam team_with(const std::string& devices, const std::string& clock = "perfect") {
  return team_of_text(R"(
shoal: 1
name: dive
medium:
  water:
    profile: [{depth_m: 0, temperature_C: 20, salinity_psu: 35}, {depth_m: 100, temperature_C: 5, salinity_psu: 35}]
vehicles:
  - name: auv
    model:
      shoal: 1
      clock: {preset: )" +
                      clock + R"(, offset_std_s: 0.005, drift_std_ppm: 1}
      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}]
      devices: [{name: modem, type: acoustic_modem, position_m: [0.5, 0, 0.1], synchronous_s: 2}, )" +
                      devices + R"(]
  - name: buoy
    model:
      shoal: 1
      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}]
)");
}

/// A craft with USBL that heads north, and an AUV.
inline NavTeam usbl_team(const std::string& heading_noise = "{gaussian_std: 0.03}") {
  return team_of_text(R"(
shoal: 1
name: usbl
medium: {water: {sound_speed_mps: 1500}}
vehicles:
  - {name: craft, model: {shoal: 1, bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}],
     devices: [{name: modem, type: acoustic_modem, position_m: [1, 0, 0]}, {name: gps, type: gps},
     {name: ahrs, type: ahrs, heading_noise: )" +
                      heading_noise + R"(},
     {name: usbl, type: usbl, position_m: [3, 0, 0], range_noise: {gaussian_std: 0.5},
      azimuth_noise: {gaussian_std: 0.04}, elevation_noise: {gaussian_std: 0.02}}]}}
  - {name: auv, model: {shoal: 1, bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}],
     devices: [{name: modem, type: acoustic_modem}, {name: gps, type: gps}, {name: pressure, type: pressure}]}}
)");
}

}  // namespace nav_team_fixture
