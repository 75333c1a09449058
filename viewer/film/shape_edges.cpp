// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/shape_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "sim/geometry/mesh.hpp"
#include "sim/scene/light.hpp"
#include "sim/world/part_collisions.hpp"

namespace viewer {

namespace {

using Lines = ShapeEdges::Lines;

constexpr sim::Color movable_color{79, 180, 119}, fixed_color{139, 151, 163};  // as on the live page
constexpr int circle_corners = 32;

/// Adds an arc about a center from `x` towards `y`, two vectors of the length of its radius.
void add_arc(Lines& lines, const sim::Vector3d& center, const sim::Vector3d& x, const sim::Vector3d& y,
             double angle_rad = 2 * std::numbers::pi) {
  const int corners = static_cast<int>(std::lround(circle_corners * angle_rad / (2 * std::numbers::pi)));
  std::vector<sim::Vector3d> points;
  for (int i = 0; i <= corners; ++i) {
    const double at_rad = angle_rad * i / corners;
    points.push_back(center + std::cos(at_rad) * x + std::sin(at_rad) * y);
  }
  lines.push_back(std::move(points));
}

/// Adds the edges of a box with these half sides.
void add_box(Lines& lines, const sim::Vector3d& half_m) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1})
      for (const int other_side : {-1, 1}) {
        sim::Vector3d from = half_m;
        from[(axis + 1) % 3] *= side;
        from[(axis + 2) % 3] *= other_side;
        sim::Vector3d to = from;
        to[axis] = -to[axis];
        lines.push_back({from, to});
      }
}

/// Adds two circles at +-half_m along z, and four lines between them.
void add_tube(Lines& lines, double radius_m, double half_m) {
  const sim::Vector3d x(radius_m, 0, 0), y(0, radius_m, 0), top(0, 0, half_m);
  add_arc(lines, top, x, y);
  add_arc(lines, -top, x, y);
  for (const sim::Vector3d& side : {x, y, sim::Vector3d(-x), sim::Vector3d(-y)})
    lines.push_back({side + top, side - top});
}

/// Returns the edges of a mesh between triangles that are not in one plane, and those of one triangle alone.
Lines lines_of(const sim::Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<sim::Vector3d>> normals;  // by edge
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    const std::vector<sim::Vector3d>& at = mesh.vertices_m;
    const sim::Vector3d normal = (at[b] - at[a]).cross(at[c] - at[a]).normalized();
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
      normals[std::minmax(from, to)].push_back(normal);
  }
  constexpr double flat = 0.9998;  // cosine of one degree
  Lines lines;
  for (const auto& [edge, of] : normals)
    if (of.size() != 2 || of[0].dot(of[1]) < flat)
      lines.push_back({mesh.vertices_m[edge.first], mesh.vertices_m[edge.second]});
  return lines;
}

}  // namespace

Lines ShapeEdges::lines_of(const sim::PartConfig& part) {
  Lines lines;
  const sim::Vector3d x(part.radius_m, 0, 0), y(0, part.radius_m, 0), z(0, 0, part.radius_m);
  switch (part.shape) {
    case sim::PartShape::box:
      add_box(lines, 0.5 * part.size_m);
      break;
    case sim::PartShape::sphere:
      add_arc(lines, sim::Vector3d::Zero(), x, y);
      add_arc(lines, sim::Vector3d::Zero(), y, z);
      add_arc(lines, sim::Vector3d::Zero(), z, x);
      break;
    case sim::PartShape::cylinder:
      add_tube(lines, part.radius_m, 0.5 * part.length_m);
      break;
    case sim::PartShape::capsule:
      add_tube(lines, part.radius_m, 0.5 * part.length_m);
      for (const sim::Vector3d& side : {x, y}) {
        const sim::Vector3d top(0, 0, 0.5 * part.length_m);
        add_arc(lines, top, side, z, std::numbers::pi);
        add_arc(lines, -top, side, -z, std::numbers::pi);
      }
      break;
    case sim::PartShape::plane:
    case sim::PartShape::mesh:
    case sim::PartShape::terrain:
      break;
  }
  return lines;
}

const Lines& ShapeEdges::lines_of_mesh(const sim::PartConfig& part) {
  const std::string path = (std::filesystem::path(part.directory) / part.mesh).string();
  const auto [known, is_new] = meshes_.try_emplace({path, part.scale});
  if (!is_new) return known->second;
  try {
    known->second = viewer::lines_of(sim::load_mesh(path, part.scale));
  } catch (const sim::MeshError&) {
    // The file has changed since the world was built: there are no edges to draw.
  }
  return known->second;
}

void ShapeEdges::draw(OverlayCanvas& canvas, const sim::PartConfig& part, const sim::Pose& X_WB, const Pen& pen) {
  const sim::Pose X_WP = X_WB * sim::make_pose(part.position_m, part.rpy_rad);
  const Lines own = part.shape == sim::PartShape::mesh ? Lines() : lines_of(part);
  for (std::vector<sim::Vector3d> line : part.shape == sim::PartShape::mesh ? lines_of_mesh(part) : own) {
    for (sim::Vector3d& point : line) point = X_WP * point;
    canvas.polyline(line, pen);
  }
}

void ShapeEdges::draw(OverlayCanvas& canvas, BodyShapes shapes) {
  const sim::PartCollisions collisions(world_);
  const auto draw_body = [&](const sim::Body& body, const std::string& owner,
                             const std::vector<sim::PartConfig>& parts) {
    for (const sim::PartConfig& part : parts) {
      Pen pen{body.fixed() ? fixed_color : movable_color, 1.5F};
      if (shapes == BodyShapes::collision && !collisions.has(part, owner)) continue;
      if (shapes == BodyShapes::wire && !part.color.empty())
        pen.color = sim::parse_color(part.color).value_or(pen.color);
      draw(canvas, part, body.X_WB(), pen);
    }
  };
  const auto draw_all = [&](const sim::Mechanism& owner, const sim::MechanismConfig& config, const std::string& name) {
    for (std::size_t i = 0; i < std::min(config.bodies.size(), owner.bodies().size()); ++i)
      draw_body(*owner.bodies()[i].second, name, config.bodies[i].parts);
  };
  for (const auto& vehicle : world_.vehicles()) draw_all(*vehicle, vehicle->config(), vehicle->name());
  for (const auto& [name, object] : world_.objects()) draw_all(object, *object.config, name);
}

}  // namespace viewer
