// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/base/math.hpp"
#include "sim/geometry/mesh.hpp"
#include "sim/rays/embree_library.hpp"
#include "sim/rays/ray_shape.hpp"

namespace sim {

/// Triangles of a mesh for ray casting, shared by all parts with this mesh.  Embree finds in single precision which
/// triangles a ray may hit; the hit is computed in double precision from the vertices of the mesh.
class TriangleScene {
 public:
  /// Keeps a reference to the mesh.
  explicit TriangleScene(const Mesh& mesh);

  /// Center and half extents of the bounding box of the mesh, in its frame.
  const Vector3d& center_m() const { return center_m_; }
  const Vector3d& half_extents_m() const { return half_extents_m_; }

  /// Records nearer hits on the part `shape` in the packet; returns the lanes (bits) that have one.
  unsigned cast(const RayShape& shape, RayPacket& rays, unsigned lanes) const;
  /// Returns the lanes of `lanes` that hit the part within their range.
  unsigned find_blocked(const RayShape& shape, const RayPacket& rays, unsigned lanes) const;
  /// Unit normal of a triangle, in the frame of the mesh.
  Vector3d normal(std::uint32_t triangle) const;

 private:
  struct Query;
  static void filter_cast(const RTCFilterFunctionNArguments* arguments);
  static void filter_blocked(const RTCFilterFunctionNArguments* arguments);
  double find_clearance(const Vector3d& low, const Vector3d& high) const;
  unsigned cast_near_edges(const RayShape& shape, RayPacket& rays, unsigned lanes) const;
  void prefetch(std::uint32_t triangle) const;
  double find_range(const Vector3d& from_M, const Vector3d& direction_M, std::uint32_t triangle) const;

  const Mesh& mesh_;
  Vector3d center_m_ = Vector3d::Zero(), half_extents_m_ = Vector3d::Zero();
  double radius_m_ = 0;
  /// Barycentric coordinates above which no other triangle is hit at about the same range; infinity: that is not known.
  double clearance_ = 0;
  EmbreeSceneHandle scene_;
};

}  // namespace sim
