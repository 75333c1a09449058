// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "sim/rays/embree_library.hpp"
#include "sim/rays/ray_shape.hpp"
#include "sim/rays/triangle_scene.hpp"
#include "sim/rays/world_scene.hpp"

namespace sim {

/// Ray casting with Embree.  Embree finds in single precision only which shapes a ray may hit; RayShape and
/// TriangleScene compute the hit in double precision.  A result thus depends only on the ray and the parts: not on the
/// processor, on other rays cast with it, or on the history of the tree.
class EmbreeScene final : public WorldScene {
 public:
  explicit EmbreeScene(const SceneMoves& moves) : moves_(moves) { moving_.moves = true; }

  void add_group(int group) override;
  void add_part(int number, const ScenePart& part) override;
  void close_group(int group) override;
  void remove_group(int group, std::span<const int> parts) override;

  void prepare() const override;
  bool concurrent() const override { return true; }

  std::optional<RayHit> cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                             const RayFilter& filter) const override;
  void cast_fan(const Fan& fan, const RayFilter& filter, std::span<RayHit> hits) const override;
  void cast(std::span<const Ray> rays, const RayFilter& filter, std::span<RayHit> hits) const override;
  void find_blocked(std::span<const Ray> rays, const RayFilter& filter, std::span<std::uint8_t> blocked) const override;

 private:
  struct Query;
  struct Targets;
  struct FanTargets;

  /// Number of shapes up to which testing each one is faster than a tree.
  static constexpr int max_few = 4;

  /// Shapes in one bounding volume hierarchy (tree).
  struct Layer {
    /// Whether no tree is used: for planes, which are infinite, and for few shapes, for which a tree is slower.
    bool few() const { return shapes.size() <= max_few || shapes.front().kind == RayShape::Kind::plane; }

    bool moves = false;
    std::vector<RayShape> shapes;
    std::vector<dxGeom*> geoms;  // of each shape
    EmbreeSceneHandle scene;
    EmbreeGeometryHandle geometry;
    Vector3d origin_W = Vector3d::Zero();  // origin of the coordinates in the tree
    double radius_m = 0;                   // of a sphere around the origin that contains all shapes
    std::uint64_t seen = ~std::uint64_t{0};
    bool changed = false;     // shapes were added or removed
    double travelled_m = 0;   // sum over shapes since the tree was built
    double half_width_m = 0;  // sum of the radii of the shapes
  };
  struct Part {
    ScenePart part;
    Layer* layer = nullptr;  // null: invisible to rays
    std::size_t at = 0;      // index in the layer
  };
  /// Triangles of a mesh, and the number of parts that use it.
  struct SharedMesh {
    std::unique_ptr<TriangleScene> triangles;
    int users = 0;
  };

  void add_shape(int number);
  Layer& layer_of(const RayShape& shape, const ScenePart& part);
  void remove_shape(Part& part);
  void refresh(Layer& layer, std::uint64_t moves) const;
  static void follow_geoms(Layer& layer);
  static void choose_origin(Layer& layer);
  static void build(Layer& layer);
  static void bounds_of(const RTCBoundsFunctionArguments* arguments);
  static void intersect(const RTCIntersectFunctionNArguments* arguments);
  static void find_occluded(const RTCOccludedFunctionNArguments* arguments);
  static unsigned cast_at(const RayShape& shape, RayPacket& rays, unsigned lanes);
  static unsigned blocked_by(const RayShape& shape, RayPacket& rays, unsigned lanes);
  static void cast_packet(RayPacket& rays, unsigned lanes, const Targets& targets);
  static unsigned blocked_packet(RayPacket& rays, unsigned lanes, const Targets& targets);
  RayHit hit_of(const RayPacket& rays, int lane) const;

  const SceneMoves& moves_;
  std::vector<Part> parts_;
  std::vector<std::vector<int>> open_;  // by group: parts not yet visible
  std::map<const Mesh*, SharedMesh> meshes_;
  /// terrain_: large meshes that do not move.
  mutable Layer planes_, moving_, fixed_, terrain_;
};

}  // namespace sim
