#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/physics/ode_library.hpp"
#include "sim/scene/box_grid.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

/// Counts of what moved, so that the scene knows when to look at the parts again.
struct SceneMoves {
  std::uint64_t moving = 0;  ///< bodies that move: each step
  std::uint64_t fixed = 0;   ///< fixed bodies: only when someone puts them elsewhere
};

/// Rays against the collision geoms.  Not for two threads at once: the ray and the lists are used over and
/// over.
///
/// A search finds the boxes around groups (vehicles, with all their moving parts) and fixed parts that it may
/// meet, looks at the nearest first, and drops what lies behind hits found already.
class OdeScene final : public Scene {
 public:
  explicit OdeScene(const SceneMoves& moves);

  // Numbers of groups and parts are the caller's, who may use those of removed things again.
  void add_group(int group);
  void add_part(int number, dGeomID geom, int group, std::uint32_t category, bool moving);
  /// From now on rays see the parts of the group.
  void close_group(int group);
  /// Rays see these parts, all that the group has, no more.
  void remove_group(int group, std::span<const int> parts);

  std::optional<RayHit> cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                             const RayFilter& filter) const override;
  void cast_fan(const Fan& fan, const RayFilter& filter, std::span<double> ranges_m) const override;

 private:
  struct Part {
    dGeomID geom = nullptr;
    int group = -1;
    std::uint32_t category = 0;
    int kind = -1;                 // ODE's class of geom
    int layer = -1, cluster = -1;  // where rays find it; -1: not closed yet, a plane, or removed
  };
  /// Parts that are found together: the moving ones of a group, or one fixed part.
  struct Cluster {
    std::vector<int> parts;
    int group;
    std::uint32_t categories;
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
  /// A fan under way.
  struct FanSearch;

  void add_cluster(int layer, Cluster cluster);
  void remove_cluster(int layer, int number);
  void refresh(Layer& layer, std::uint64_t moves) const;
  void refresh() const;
  bool passes(const Cluster& cluster, const RayFilter& filter) const {
    return cluster.group != filter.exclude_group && (cluster.categories & filter.categories) != 0;
  }
  bool hit(int part, const Vector3d& origin_W, const Vector3d& direction_W, RayHit& nearest) const;
  void find_candidates(const AlignedBox& around, const RayFilter& filter, const Vector3d& from_W,
                       double range_max_m) const;
  const std::vector<Vector3d>& directions(const Fan& fan) const;

  const SceneMoves& moves_;
  std::vector<Part> parts_;
  std::vector<std::vector<int>> open_;  // by group: moving parts not yet seen
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
