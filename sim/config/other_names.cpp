// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <span>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

struct Pair {
  std::string_view from, to;
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

std::string_view synonym_of(std::string_view word) {
  return find(synonyms, word);
}

}  // namespace sim
