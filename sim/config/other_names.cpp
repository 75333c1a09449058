// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/other_names.hpp"

#include <algorithm>
#include <iterator>
#include <span>

namespace sim {

namespace {

struct Pair {
  std::string_view from, to;
};

/// Names of version 0.1; `shoal upgrade` rewrites them (tools/experiment/upgrade/renames.cpp).
constexpr Pair former_names[] = {
    {"lean", "tilt"},
    {"longest_gap_s", "max_gap_s"},
    {"rms_deg", "pitch_std_deg"},
    {"mean_deg", "pitch_mean_deg"},
    {"pictures", "plots"},
    {"ticks_per_turn", "ticks_per_revolution"},
    {"lets_through", "transparent_to"},
    {"inaudible_dB", "negligible_dB"},
    {"bandwidth_hz", "bandwidth_Hz"},
    {"bounce_velocity_mps", "restitution_velocity_mps"},
};

/// Words of URDF, SDF and other simulators.
constexpr Pair synonyms[] = {
    {"revolute", "hinge"},
    {"continuous", "hinge"},
    {"prismatic", "slider"},
    {"spherical", "ball"},
    {"cube", "box"},
    {"laser", "lidar"},
    {"diff_drive", "differential_drive"},
    {"differential", "differential_drive"},
    {"gnss", "gps"},
    {"ins", "ahrs"},
    {"depth", "pressure"},
    {"sphere_joint", "ball"},
    {"yaw", "rpy_deg"},
    {"yaw_deg", "rpy_deg"},
    {"heading_deg", "rpy_deg"},
    {"orientation", "rpy_deg"},
    {"rotation", "rpy_deg"},
    {"xyz", "position_m"},
};

std::string_view find(std::span<const Pair> pairs, std::string_view name) {
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& pair) { return pair.from == name; });
  return found == pairs.end() ? std::string_view() : found->to;
}

}  // namespace

std::string_view renamed_to(std::string_view former) {
  return find(former_names, former);
}

std::string_view synonym_of(std::string_view word) {
  return find(synonyms, word);
}

}  // namespace sim
