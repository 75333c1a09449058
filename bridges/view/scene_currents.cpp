// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/view/scene_currents.hpp"

#include <algorithm>

namespace bridges {

namespace {

using Json = nlohmann::ordered_json;

/// Writes a grid; one with more points is sampled at fewer places.
Json grid_json(const sim::CurrentGrid& grid) {
  constexpr int max_points = 64;
  const int columns = std::min(grid.columns(), max_points), rows = std::min(grid.rows(), max_points);
  const Eigen::Vector2d low_m = grid.low_m(), high_m = grid.high_m();
  Json velocities = Json::array();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      // Rounding must not exceed the ends: there may be no current outside of the grid.
      const double x_m = std::min(high_m.x(), low_m.x() + i * (high_m.x() - low_m.x()) / (columns - 1));
      const double y_m = std::min(high_m.y(), low_m.y() + j * (high_m.y() - low_m.y()) / (rows - 1));
      const sim::Vector3d v_W = grid.velocity_W(x_m, y_m);
      velocities.push_back({v_W.x(), v_W.y()});
    }
  return {{"type", "grid"},
          {"low_m", {low_m.x(), low_m.y()}},
          {"high_m", {high_m.x(), high_m.y()}},
          {"columns", columns},
          {"rows", rows},
          {"outside", grid.keeps_edge() ? "edge" : "zero"},
          {"velocities_mps", std::move(velocities)}};
}

Json current_json(const sim::CurrentConfig& entry) {
  using Type = sim::CurrentConfig::Type;
  switch (entry.type) {
    case Type::constant: {
      const sim::Vector3d& v = entry.velocity_mps;
      return {{"type", "constant"}, {"velocity_mps", {v.x(), v.y(), v.z()}}};
    }
    case Type::profile: {
      Json rows = Json::array();
      for (const sim::CurrentLayerConfig& row : entry.profile) {
        const sim::Vector3d& v = row.velocity_mps;
        rows.push_back({row.depth_m, v.x(), v.y(), v.z()});
      }
      return {{"type", "profile"}, {"rows", std::move(rows)}};
    }
    case Type::power_law:
      return {{"type", "power_law"},
              {"speed_mps", entry.speed_mps},
              {"direction_rad", entry.direction_rad},
              {"water_depth_m", entry.water_depth_m},
              {"exponent", entry.exponent}};
    case Type::wind_driven:
      return {{"type", "wind_driven"},
              {"speed_mps", entry.speed_mps},
              {"direction_rad", entry.direction_rad},
              {"reference_depth_m", entry.reference_depth_m}};
    case Type::gauss_markov:
      return {{"type", "gauss_markov"}, {"speed_mps", entry.speed_mps}, {"direction_rad", entry.direction_rad}};
    case Type::vortex:
      return {{"type", "vortex"},
              {"center_m", {entry.center_m[0], entry.center_m[1]}},
              {"peak_speed_mps", entry.peak_speed_mps},
              {"core_radius_m", entry.core_radius_m},
              {"core", entry.core == sim::CurrentConfig::Core::rankine ? "rankine" : "lamb_oseen"}};
    case Type::grid:
      break;  // grid_json()
  }
  return {};
}

}  // namespace

Json tides_json(const std::vector<sim::TideConfig>& tides) {
  Json all = Json::array();
  for (const sim::TideConfig& tide : tides)
    all.push_back({{"amplitude_m", tide.amplitude_m},
                   {"period_s", tide.period_s},
                   {"phase_rad", tide.phase_rad},
                   {"current_mps", tide.current_mps},
                   {"current_direction_rad", tide.current_direction_rad},
                   {"current_lead_rad", tide.current_lead_rad}});
  return all;
}

Json currents_json(const std::vector<sim::CurrentConfig>& entries, const sim::Current& current) {
  Json all = Json::array();
  auto grid = current.grids().begin();
  for (const sim::CurrentConfig& entry : entries)
    all.push_back(entry.type == sim::CurrentConfig::Type::grid ? grid_json(*grid++) : current_json(entry));
  return all;
}

}  // namespace bridges
