// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "autonomy/known_map/distance_field.hpp"

namespace autonomy {

/// Space that a vehicle drives through.
struct PlanGrid {
  GridFrame frame;
  std::vector<float> clearance_m;  ///< distance to the nearest obstacle
  std::vector<char> unknown;       ///< whether nothing is known of the cell

  /// Returns the clearance at a point; 0 outside of the grid.
  double clearance_at(const Vector2d& p_W) const;
};

/// Costs of a meter of a path.  On free ground it costs 1.
struct PathCosts {
  double keep_m = 0.6;    ///< smallest distance of the middle of the vehicle to an obstacle
  double prefer_m = 1.2;  ///< nearer than this a meter costs more, and `clearance_cost` more at keep_m
  double clearance_cost = 2;
  double unknown_cost = 2;     ///< a meter of unknown ground costs this much more
  bool enters_unknown = true;  ///< else unknown ground is impassable
};

struct Path {
  std::vector<Vector2d> points_W;  ///< from the start to the goal; empty: there is impassable
  std::string why_none;            ///< rule and values, when there is impassable
};

/// Returns the path of the lowest cost: by A* (Hart, Nilsson and Raphael 1968) to 16 neighbors of each cell, with the
/// straight distance as the bound; then points are left out where the straight line costs no more.  A vehicle that
/// starts too near to an obstacle may leave it.
Path search_path(const PlanGrid& grid, const Vector2d& from_W, const Vector2d& to_W, const PathCosts& costs);

}  // namespace autonomy
