// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// Radar cross section of a vehicle or an object, in place of that by its area.
struct RadarCrossSection {
  std::string name;
  double rcs_m2 = 10;
  void read(sim::ParamReader& in);
};

/// Direction in which a radar looks: the axis of its beam, in the horizontal plane of W.
struct RadarLook {
  sim::Pose X_WS = sim::Pose::Identity();
  double heading_rad = 0;  ///< of the axis, counter-clockwise from east
  double surface_m = 0;    ///< height of the still sea in W; minus infinity without one
  double height_m = 0;     ///< of the antenna above it

  sim::Vector3d ahead_W() const { return {std::cos(heading_rad), std::sin(heading_rad), 0}; }
  sim::Vector3d left_W() const { return {-std::sin(heading_rad), std::cos(heading_rad), 0}; }
};

/// Vehicle or object that a radar may see.
struct RadarTarget {
  /// Rectangle of directions: azimuths counter-clockwise from the axis of the beam, elevations above the horizon.
  struct Outline {
    double right_rad, left_rad, bottom_rad, top_rad;
    double near_m;  ///< distance of its nearest corner
  };

  int group = -1;
  bool land = false;             ///< it has a plane or a terrain: its size is not known
  std::optional<double> rcs_m2;  ///< unset: by its area
  /// Bodies, and the boxes around their parts in their frames.
  std::vector<std::pair<const sim::Body*, Eigen::AlignedBox3d>> boxes_B;

  /// Whether it may be within an angle of the axis of the beam, and within a distance.
  bool may_be_within(const RadarLook& look, double half_width_rad, double distance_m) const;
  /// Returns the outline of what is above the sea; empty: nothing.
  std::optional<Outline> outline(const RadarLook& look) const;
};

/// All vehicles and objects of a world except the one that carries the radar.
class RadarTargets {
 public:
  /// Lists them again when vehicles or objects were added or removed.
  void update(const sim::World& world, int own_group, std::span<const RadarCrossSection> rcs);
  std::span<const RadarTarget> all() const { return targets_; }
  /// Returns the index in all() of the target of a group; -1: none.
  int of_group(int group) const {
    return static_cast<std::size_t>(group) < indices_.size() ? indices_[static_cast<std::size_t>(group)] : -1;
  }
  /// Makes the next update() list them again.
  void forget() { generation_.reset(); }

 private:
  void add(const sim::Mechanism& mechanism, const sim::MechanismConfig& config, const std::string& name,
           std::span<const RadarCrossSection> rcs);

  std::vector<RadarTarget> targets_;
  std::vector<int> indices_;                                                  ///< by group
  std::map<std::pair<std::string, double>, Eigen::AlignedBox3d> mesh_boxes_;  ///< by file and scale
  std::optional<std::uint64_t> generation_;
};

}  // namespace devices
