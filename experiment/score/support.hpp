// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sim/base/math.hpp"

namespace sim {
class Vehicle;
class World;
}  // namespace sim

namespace experiment {

/// How a vehicle stands on its contacts in the last step.  Margins are signed distances to the nearest edge of the
/// support polygon, seen from above, m: negative outside.
struct Support {
  std::vector<Eigen::Vector2d> polygon_W;  ///< convex hull of the contacts, counter-clockwise; m
  double static_margin_m = 0;              ///< of the center of mass
  double zmp_margin_m = 0;                 ///< of the center of pressure (ZMP), never outside
  double capture_margin_m = 0;             ///< of the capture point, at which a step would bring the vehicle to rest
  double nesm_m = 0;                       ///< height that the center of mass must rise to tip over an edge; 0: outside
};

/// Returns how a vehicle stands; none when fewer than three contacts carry it.  The contacts of its group must be
/// watched.
///
/// The center of pressure is the mean of the contacts by their vertical forces, on level ground the zero-moment point.
/// The capture point is x + v sqrt(z / g) of the linear inverted pendulum (Pratt et al. 2006, "Capture point: a step
/// toward humanoid push recovery"), the height over an edge the normalized energy stability margin (Hirose et al.
/// 1998).
std::optional<Support> support_of(const sim::World& world, const sim::Vehicle& vehicle);

/// Returns the convex hull of points, counter-clockwise, without points on its edges.
std::vector<Eigen::Vector2d> convex_hull_of(std::vector<Eigen::Vector2d> points);

/// Returns the signed distance of a point to the nearest edge of a convex polygon, counter-clockwise, of three corners
/// or more: positive inside.
double margin_in(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point);

}  // namespace experiment
