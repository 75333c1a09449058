// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace experiment {

namespace {

using Eigen::Vector2d;
using sim::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Mass, center of mass and its velocity.
struct Center {
  double mass_kg = 0;
  Vector3d p_W = Vector3d::Zero(), v_W = Vector3d::Zero();
};

Center center_of(const sim::Vehicle& vehicle) {
  Center center;
  for (const auto& [name, body] : vehicle.bodies()) {
    const double mass_kg = body->mass_kg();
    if (mass_kg <= 0) continue;
    center.mass_kg += mass_kg;
    center.p_W += mass_kg * (body->X_WB() * body->p_BC());
    center.v_W += mass_kg * body->velocity_at_W(body->p_BC());
  }
  if (center.mass_kg > 0) {
    center.p_W /= center.mass_kg;
    center.v_W /= center.mass_kg;
  }
  return center;
}

/// Least height that the center of mass rises when the vehicle turns over an edge, m.
double height_over_edges(const std::vector<Vector3d>& contacts_W, const std::vector<Vector2d>& polygon,
                         const Vector3d& center_W) {
  const auto height_at = [&](const Vector2d& corner) {
    double height = 0;
    for (const Vector3d& contact : contacts_W)
      if (contact.head<2>() == corner) height = contact.z();
    return height;
  };
  double rise = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    const Vector3d from(a.x(), a.y(), height_at(a)), to(b.x(), b.y(), height_at(b));
    const Vector3d axis = (to - from).normalized();
    const Vector3d arm = (center_W - from) - axis * axis.dot(center_W - from);  // from the edge, square to it
    const double slope = std::hypot(axis.x(), axis.y());                        // cos of the slope of the edge
    // Highest point of the circle around the edge.
    rise = std::min(rise, arm.norm() * slope - arm.z());
  }
  return std::max(rise, 0.0);
}

}  // namespace

std::vector<Vector2d> convex_hull_of(std::vector<Vector2d> points) {
  // Andrew 1979, "Another efficient algorithm for convex hulls in two dimensions": lower, then upper chain.
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vector2d& point : points) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // it starts the other chain
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double margin_in(const std::vector<Vector2d>& polygon, const Vector2d& point) {
  double inside = std::numeric_limits<double>::infinity(), outside = std::numeric_limits<double>::infinity();
  bool is_inside = true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d along = polygon[(i + 1) % polygon.size()] - a;
    const double distance = cross(along, point - a) / along.norm();
    is_inside = is_inside && distance >= 0;
    inside = std::min(inside, distance);
    // Outside of a polygon the nearest point may be a corner.
    const double share = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    outside = std::min(outside, (point - a - share * along).norm());
  }
  return is_inside ? inside : -outside;
}

std::optional<Support> support_of(const sim::World& world, const sim::Vehicle& vehicle) {
  // Contacts with anything else, and the force on the vehicle.
  std::vector<Vector3d> contacts_W;
  std::vector<Vector2d> points;
  Vector2d weighted = Vector2d::Zero();
  double force_N = 0;
  const auto parts = world.physics().parts();
  for (const sim::ContactReport& contact : world.physics().contacts()) {
    const bool first = parts[static_cast<std::size_t>(contact.parts[0])].group == vehicle.group();
    const bool second = parts[static_cast<std::size_t>(contact.parts[1])].group == vehicle.group();
    if (first == second) continue;
    const double up_N = first ? contact.force_W_N.z() : -contact.force_W_N.z();
    if (up_N <= 0) continue;  // it carries nothing
    contacts_W.push_back(contact.position_W);
    points.push_back(contact.position_W.head<2>());
    weighted += up_N * contact.position_W.head<2>();
    force_N += up_N;
  }
  Support support;
  support.polygon_W = convex_hull_of(points);
  if (support.polygon_W.size() < 3) return std::nullopt;
  // Center of mass, its height above the contacts, and the points below it.
  const Center center = center_of(vehicle);
  double ground_m = 0;
  for (const Vector3d& contact : contacts_W) ground_m += contact.z() / static_cast<double>(contacts_W.size());
  const double gravity_mps2 = world.physics().gravity_mps2();
  const double pendulum_s = gravity_mps2 > 0 ? std::sqrt(std::max(center.p_W.z() - ground_m, 0.0) / gravity_mps2) : 0.0;
  const Vector2d below = center.p_W.head<2>();
  const Vector2d capture = below + pendulum_s * center.v_W.head<2>();
  const Vector2d zmp = weighted / force_N;
  support.static_margin_m = margin_in(support.polygon_W, below);
  support.zmp_margin_m = margin_in(support.polygon_W, zmp);
  support.capture_margin_m = margin_in(support.polygon_W, capture);
  support.nesm_m = support.static_margin_m > 0 ? height_over_edges(contacts_W, support.polygon_W, center.p_W) : 0;
  return support;
}

}  // namespace experiment
