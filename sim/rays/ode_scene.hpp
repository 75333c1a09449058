// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sim/geometry/box_grid.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/rays/world_scene.hpp"

namespace sim {

/// Ray casting against ODE's collision geoms.  Not thread-safe: the ray and the lists are reused.
///
/// A search finds the bounding boxes of groups (vehicles, with all their moving parts) and fixed parts on the ray,
/// tests the nearest first, and skips those behind a hit.
class OdeScene final : public WorldScene {
 public:
  explicit OdeScene(const SceneMoves& moves);

  void add_group(int group) override;
  void add_part(int number, const ScenePart& part) override;
  void close_group(int group) override;
  void remove_group(int group, std::span<const int> parts) override;

  using Scene::cast;
  std::optional<RayHit> cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                             const RayFilter& filter) const override;
  void cast_fan(const Fan& fan, const RayFilter& filter, std::span<RayHit> hits) const override;
  void prepare() const override { refresh(); }

 private:
  /// Triangles used only for rays.
  struct TriangleGeom {
    TriMeshDataHandle data;
    GeomHandle geom;
  };
  struct Part : ScenePart {
    int kind = -1;                            // ODE's class of geom
    int layer = -1, cluster = -1;             // -1: not closed yet, a plane, or removed
    std::shared_ptr<TriangleGeom> triangles;  // of terrain, whose geom rays cannot hit; made on first use
  };
  /// Parts with a common bounding box: the moving ones of a group, or one fixed part.
  struct Cluster {
    std::vector<int> parts;
    int group;
    std::uint32_t categories;  // of all its parts
  };
  struct Layer {
    std::vector<Cluster> clusters;
    BoxGrid grid;
    std::uint64_t seen = ~std::uint64_t{0};
  };
  struct Candidate {
    double nearest_m;
    int layer, cluster;
  };
  /// Search for the hits of a fan.
  struct FanSearch;

  void add_cluster(int layer, Cluster cluster);
  void remove_cluster(int layer, int number);
  static void place_triangles(Part& part);
  void refresh(Layer& layer, std::uint64_t moves) const;
  void refresh() const;
  static bool stops(const Cluster& cluster, const RayFilter& filter) {
    return cluster.group != filter.exclude_group && (cluster.categories & filter.categories) != 0;
  }
  static bool stops(const Part& part, const RayFilter& filter) {
    return part.group != filter.exclude_group && (part.category & filter.categories) != 0 &&
           (part.transmits & static_cast<std::uint8_t>(filter.kind)) == 0;
  }
  bool hit(int part, const Vector3d& origin_W, const Vector3d& direction_W, RayHit& nearest) const;
  void find_candidates(const AlignedBox& around, const RayFilter& filter, const Vector3d& from_W,
                       double range_max_m) const;
  const std::vector<Vector3d>& directions(const Fan& fan) const;

  const SceneMoves& moves_;
  mutable std::vector<Part> parts_;
  std::vector<std::vector<int>> open_;  // by group: moving parts not yet visible
  std::vector<int> open_fixed_;
  std::vector<int> planes_;
  mutable Layer layers_[2];  // moving, fixed
  mutable std::vector<Candidate> candidates_;
  mutable std::vector<AlignedBox> part_boxes_, cluster_boxes_;
  mutable std::vector<Vector3d> directions_S_;
  mutable Fan directions_of_;
  GeomHandle ray_;
};

}  // namespace sim
