// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Shape of a zone.
enum class ZoneShape { box, sphere, cylinder, polygon };

inline constexpr ChoiceWords<ZoneShape> zone_shape_words{{"box", ZoneShape::box},
                                                         {"sphere", ZoneShape::sphere},
                                                         {"cylinder", ZoneShape::cylinder},
                                                         {"polygon", ZoneShape::polygon}};

/// Service that a zone denies to the vehicles inside.
enum class ZoneFlag { gps_denied, radio_denied };

/// Named region of the world for events, denied services and rules.  It takes no part in collisions.
struct ZoneConfig {
  std::string name;
  ZoneShape shape = ZoneShape::box;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  Vector3d size_m = Vector3d::Ones();  ///< box
  double radius_m = 1;                 ///< sphere, cylinder
  double height_m = 1;                 ///< cylinder, along z
  std::vector<Vector3d> points_m;      ///< polygon: corners in the zone's xy-plane
  double low_m = -1e9;                 ///< polygon: lower limit of z in the zone's frame
  double high_m = 1e9;                 ///< polygon: upper limit of z
  bool gps_denied = false;
  bool radio_denied = false;
  std::optional<double> speed_limit_mps;
  bool finish = false;

  void read(ParamReader& in);
};

/// Zone at its pose in the world.  The border is part of the zone.
class Zone {
 public:
  explicit Zone(const ZoneConfig& config);
  /// Returns true when a point lies inside the zone or on its border.
  bool contains(const Vector3d& p_W) const;
  const ZoneConfig& config() const { return config_; }

 private:
  bool inside_polygon(const Vector3d& p_Z) const;

  ZoneConfig config_;
  Pose X_ZW_;
};

/// All zones of a world, in the order of the file.
class Zones {
 public:
  explicit Zones(const std::vector<ZoneConfig>& configs);
  /// Returns true when a service is denied at a point.
  bool denied(ZoneFlag flag, const Vector3d& p_W) const;
  const std::vector<Zone>& all() const { return all_; }
  /// Returns the index of a zone by name; -1 when there is none.
  int index_of(const std::string& name) const;

 private:
  std::vector<Zone> all_;
  std::vector<int> gps_denied_, radio_denied_;  ///< indices in all_
};

}  // namespace sim
