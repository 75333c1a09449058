// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_piece.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "sim/config/diagnostics.hpp"

namespace sim {

namespace {

Vector3d drag_of(const PartConfig& part) {
  const std::vector<double>& given = part.drag_coefficient;
  if (given.empty()) return shape_info(part.shape).drag_coefficient;
  return given.size() == 1 ? Vector3d(Vector3d::Constant(given[0])) : Vector3d(given[0], given[1], given[2]);
}

/// Angular drag areas by strip theory: each strip of a face has its own flow speed, which gives the integral of
/// |r|^3 over a side.
Vector3d angular_drag(const Vector3d& C, const Vector3d& size) {
  Vector3d drag;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    drag[i] = size[i] * (C[k] * std::pow(size[j], 4) + C[j] * std::pow(size[k], 4)) / 32;
  }
  return drag;
}

/// Fraction of the angular drag for rotation about the axis of symmetry: skin friction only.
constexpr double spin_share = 0.05;

ImmersedPiece sphere_piece(const PartConfig& part, const Vector3d& C) {
  ImmersedPiece piece;
  piece.shape = ImmersedPiece::Shape::sphere;
  piece.size_m = Vector3d::Constant(2 * part.radius_m);
  piece.radius_m = part.radius_m;
  piece.drag_area_m2 = C * std::numbers::pi * part.radius_m * part.radius_m;
  piece.angular_drag_area_m5 = spin_share * angular_drag(C, piece.size_m);
  return piece;
}

ImmersedPiece box_piece(const Vector3d& size, const Vector3d& C) {
  ImmersedPiece piece;
  piece.size_m = size;
  piece.radius_m = size.norm() / 2;
  piece.drag_area_m2 = C.cwiseProduct(Vector3d(size.y() * size.z(), size.z() * size.x(), size.x() * size.y()));
  piece.angular_drag_area_m5 = angular_drag(C, size);
  return piece;
}

/// Section of a cylinder or capsule from `low` to `high` along its axis.  The water is evaluated at the center of the
/// section, not of the part.
ImmersedPiece round_piece(const PartConfig& part, double low, double high, const Vector3d& C) {
  ImmersedPiece piece;
  piece.shape = ImmersedPiece::Shape::round;
  const double r = part.radius_m;
  piece.round = {r, part.length_m / 2, part.shape == PartShape::capsule, low, high};
  piece.size_m = {2 * r, 2 * r, high - low};
  piece.p_BP.z() = (low + high) / 2;
  piece.radius_m = std::hypot(r, (high - low) / 2);
  const double side = 2 * r * (high - low);
  piece.drag_area_m2 = C.cwiseProduct(Vector3d(side, side, std::numbers::pi * r * r));
  piece.angular_drag_area_m5 = angular_drag(C, piece.size_m);
  piece.angular_drag_area_m5.z() *= spin_share;
  return piece;
}

ImmersedPiece mesh_piece(Mesh mesh, const Vector3d& C) {
  Vector3d low = Vector3d::Constant(1e300), high = -low;
  for (const Vector3d& p : mesh.vertices_m) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vector3d middle = (low + high) / 2;
  for (Vector3d& p : mesh.vertices_m) p -= middle;
  ImmersedPiece piece = box_piece(high - low, C);
  piece.shape = ImmersedPiece::Shape::mesh;
  piece.p_BP = middle;
  piece.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return piece;
}

std::shared_ptr<const Mesh> closed_mesh(const PartConfig& part, const std::string& who, PieceMeshes& meshes,
                                        std::optional<std::string>& warning) {
  const std::string path = (std::filesystem::path(part.directory) / part.mesh).string();
  // Instances of a vehicle share one mesh. An open one is remembered as a null pointer, so that it is not read again.
  const auto [at, added] = meshes.try_emplace({path, part.scale});
  if (added) {
    try {
      Mesh mesh = load_mesh(path, part.scale);
      if (is_closed(mesh)) {
        if (solid_of(mesh).volume_m3 < 0) turn_inside_out(mesh);
        at->second = std::make_shared<const Mesh>(std::move(mesh));
      }
    } catch (const MeshError& error) {
      throw_config_error(part.place, who, "mesh '" + path + "' " + error.what());
    }
  }
  if (at->second) return at->second;
  const std::string open = "mesh '" + part.mesh + "' has an open surface, so that the water it displaces is unknown";
  if (part.displaces_was_given) throw_config_error(part.place, who, open + ": close it, or set 'displaces' to false");
  warning = open + ": it displaces none";
  return nullptr;
}

/// Lower and upper corner in the axes of a part that is not a sphere.
std::pair<Vector3d, Vector3d> extent_of(const PartConfig& part, const Mesh* mesh) {
  Vector3d low = -part.size_m / 2, high = part.size_m / 2;
  if (mesh != nullptr) {
    low = high = mesh->vertices_m[mesh->triangles.front()[0]];
    for (const Vector3d& p : mesh->vertices_m) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  } else if (shape_info(part.shape).round) {
    const double half = part.length_m / 2 + (part.shape == PartShape::capsule ? part.radius_m : 0);
    low.z() = -half;
    high.z() = half;
  }
  return {low, high};
}

struct Section {
  int axis;
  double from, length;
  bool whole;  ///< the section is the whole part
};

/// Returns a section of a part; empty when it has no volume.
std::optional<ImmersedPiece> section_piece(const PartConfig& part, const Mesh* mesh, const Section& section,
                                           const Vector3d& C) {
  const auto [axis, from, length, whole] = section;
  const double to = from + length;
  switch (part.shape) {
    case PartShape::box: {
      Vector3d size = part.size_m;
      size[axis] = length;
      ImmersedPiece piece = box_piece(size, C);
      piece.p_BP[axis] = (from + to) / 2;
      return piece;
    }
    case PartShape::mesh: {
      Mesh cut = whole ? *mesh : section_of(*mesh, axis, from, to);
      if (cut.triangles.empty()) return std::nullopt;
      return mesh_piece(std::move(cut), C);
    }
    case PartShape::capsule:
    case PartShape::cylinder:
      return round_piece(part, from, to, C);
    case PartShape::sphere:
      return sphere_piece(part, C);
    case PartShape::plane:
    case PartShape::terrain:
      break;
  }
  return std::nullopt;
}

/// Returns the pieces in the frame of the part.
std::vector<ImmersedPiece> pieces_in_part(const PartConfig& part, double max_m, const Mesh* mesh) {
  const Vector3d C = drag_of(part);
  if (part.shape == PartShape::sphere) return {sphere_piece(part, C)};
  const auto [low, high] = extent_of(part, mesh);
  int axis = 2;
  if (!shape_info(part.shape).round) (high - low).maxCoeff(&axis);
  const double whole = high[axis] - low[axis];
  const int sections = static_cast<int>(std::clamp(std::ceil(whole / max_m), 1.0, 8.0));
  const double from = low[axis], length = whole / sections;
  Vector3d shared_ends = Vector3d::Ones();  // the sections share the drag of one end face
  shared_ends[axis] = 1.0 / sections;
  const Vector3d C_section = C.cwiseProduct(shared_ends);
  std::vector<ImmersedPiece> pieces;
  for (int i = 0; i < sections; ++i) {
    auto piece = section_piece(part, mesh, {axis, from + i * length, length, sections == 1}, C_section);
    if (piece) pieces.push_back(std::move(*piece));
  }
  return pieces;
}

}  // namespace

ImmersedVolume ImmersedPiece::immersed(const WaterPlane& plane) const {
  switch (shape) {
    case Shape::sphere:
      return immersed_sphere(radius_m, plane);
    case Shape::box:
      return immersed_box(size_m, plane);
    case Shape::mesh:
      return immersed_mesh(*mesh, plane);
    case Shape::round:
      break;
  }
  // The solid is relative to the center of the part, the piece to its own center.
  const double shift = (round.low_m + round.high_m) / 2;
  ImmersedVolume volume = immersed_round(round, {plane.normal, plane.level_m + shift * plane.normal.z()});
  if (volume.volume_m3 > 0) volume.centroid_m.z() -= shift;
  return volume;
}

std::vector<ImmersedPiece> pieces_of(const PartConfig& part, double max_m, const std::string& who, PieceMeshes& meshes,
                                     std::optional<std::string>& warning) {
  if (!part.displaces || !shape_info(part.shape).solid) return {};
  std::shared_ptr<const Mesh> mesh;
  if (part.shape == PartShape::mesh) {
    mesh = closed_mesh(part, who, meshes, warning);
    if (!mesh) return {};
  }
  std::vector<ImmersedPiece> pieces = pieces_in_part(part, max_m, mesh.get());
  const Matrix3d R_BG = rotation_from_rpy(part.rpy_rad);
  for (ImmersedPiece& piece : pieces) {
    piece.R_BP = R_BG;
    piece.p_BP = part.position_m + R_BG * piece.p_BP;
    piece.added_mass_coefficient = part.added_mass_coefficient;
    // All of it under a water plane above its highest point.
    piece.whole = piece.immersed({Vector3d::UnitZ(), 2 * piece.radius_m + 1});
  }
  return pieces;
}

}  // namespace sim
