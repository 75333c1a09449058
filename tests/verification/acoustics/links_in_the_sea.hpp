// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "verification/acoustics/acoustic_closed_forms.hpp"
#include "verification/acoustics/acoustic_link.hpp"
#include "verification/acoustics/ray_picture.hpp"

namespace links_in_the_sea {

inline sim::Medium sea(double c_mps = 1500, double wind_mps = 5) {
  sim::MediumConfig config;
  config.water.emplace().sound_speed_mps = c_mps;
  config.wind.emplace().velocity_mps = sim::Vector3d(wind_mps, 0, 0);
  return sim::Medium(config, 9.80665, 1);
}

inline verification::AcousticLink link_over(double range_m) {
  verification::AcousticLink link;
  link.from.p_W = sim::Vector3d(0, 0, -20);
  link.to.p_W = sim::Vector3d(range_m, 0, -20);
  return link;
}

inline sim::AcousticsConfig thorp() {
  sim::AcousticsConfig config;
  config.absorption.model = sim::AbsorptionConfig::Model::thorp;
  return config;
}

/// A mixed layer over a thermocline, with the speeds of the reference.
inline sim::Medium thermocline() {
  sim::MediumConfig config;
  auto& profile = config.water.emplace().profile;
  for (const auto& [depth_m, speed_mps] : {std::pair{0.0, 1515.80}, {20, 1516.12}, {40, 1483.07}, {200, 1485.68}})
    profile.push_back({depth_m, 8, 35, {}, speed_mps});
  return sim::Medium(config, 9.80665, 1);
}

inline verification::AcousticLink to_50_m(double range_m) {
  verification::AcousticLink link;
  link.from.p_W = sim::Vector3d(0, 0, -1);
  link.to.p_W = sim::Vector3d(range_m, 0, -50);
  return link;
}

}  // namespace links_in_the_sea
