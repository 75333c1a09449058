// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/zone.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "sim/config/common_keys.hpp"

namespace sim {

namespace {

/// Reports keys of other shapes, which would be ignored, and missing keys of this shape.
void check_keys(ParamReader& in, ZoneShape shape) {
  const std::string word(word_of(zone_shape_words, shape));
  const auto belongs_to = [&](const char* key, std::initializer_list<ZoneShape> shapes, bool required) {
    const bool belongs = std::find(shapes.begin(), shapes.end(), shape) != shapes.end();
    if (in.has(key) && !belongs) in.error(key, "'" + std::string(key) + "' does not apply to a " + word);
    if (!in.describing() && !in.has(key) && belongs && required) in.error("a " + word + " needs '" + key + "'");
  };
  belongs_to("size_m", {ZoneShape::box}, true);
  belongs_to("radius_m", {ZoneShape::sphere, ZoneShape::cylinder}, true);
  belongs_to("height_m", {ZoneShape::cylinder}, true);
  belongs_to("points_m", {ZoneShape::polygon}, true);
  belongs_to("low_m", {ZoneShape::polygon}, false);
  belongs_to("high_m", {ZoneShape::polygon}, false);
}

}  // namespace

void ZoneConfig::read(ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the zone, unique in the world");
  in.require("shape");
  in.read_choice("shape", shape, zone_shape_words, "shape of the region");
  in.read("position_m", position_m, any_number(), "center; polygon: the origin of its corners");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch, yaw");
  in.read("size_m", size_m, above(0), "box: its lengths along x, y, z");
  in.read("radius_m", radius_m, above(0), "sphere, cylinder");
  in.read("height_m", height_m, above(0), "cylinder: along z");
  read_points(in, "points_m", points_m, 2, "polygon: three or more corners, in order");
  in.read("low_m", low_m, any_number(), "polygon: lower end, in z of the zone");
  in.read("high_m", high_m, any_number(), "polygon: upper end, in z of the zone");
  in.read("gps_denied", gps_denied, "antennas inside have no fix");
  in.read("radio_denied", radio_denied, "modems inside neither send nor receive");
  in.read("speed_limit_mps", speed_limit_mps, at_least(0),
          "speed limit; the time above it is counted for each vehicle");
  in.read("finish", finish, "the time at which each vehicle first enters is recorded");
  check_keys(in, shape);
  if (in.has("points_m") && points_m.size() < 3)
    in.error("points_m", "'points_m' must have at least 3 corners, got " + std::to_string(points_m.size()));
  if (low_m >= high_m) in.error("high_m", "'high_m' must be above 'low_m'");
}

Zone::Zone(const ZoneConfig& config) : config_(config), X_ZW_(make_pose(config.position_m, config.rpy_rad).inverse()) {}

bool Zone::contains(const Vector3d& p_W) const {
  const Vector3d p_Z = X_ZW_ * p_W;
  switch (config_.shape) {
    case ZoneShape::box:
      return (2 * p_Z.cwiseAbs() - config_.size_m).maxCoeff() <= 0;
    case ZoneShape::sphere:
      return p_Z.squaredNorm() <= config_.radius_m * config_.radius_m;
    case ZoneShape::cylinder:
      return p_Z.head<2>().squaredNorm() <= config_.radius_m * config_.radius_m &&
             2 * std::abs(p_Z.z()) <= config_.height_m;
    case ZoneShape::polygon:
      return p_Z.z() >= config_.low_m && p_Z.z() <= config_.high_m && inside_polygon(p_Z);
  }
  return false;
}

bool Zone::inside_polygon(const Vector3d& p_Z) const {
  // Even-odd rule: a ray to +x from a point inside crosses the outline an odd number of times.  A corner counts with
  // the edge above it only.
  bool inside = false;
  const auto& corners = config_.points_m;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vector3d& a = corners[i];
    const Vector3d& b = corners[j];
    if ((a.y() > p_Z.y()) == (b.y() > p_Z.y())) continue;
    if (p_Z.x() < a.x() + (b.x() - a.x()) * (p_Z.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

Zones::Zones(const std::vector<ZoneConfig>& configs) {
  all_.reserve(configs.size());
  for (const ZoneConfig& config : configs) {
    if (config.gps_denied) gps_denied_.push_back(static_cast<int>(all_.size()));
    if (config.radio_denied) radio_denied_.push_back(static_cast<int>(all_.size()));
    all_.emplace_back(config);
  }
}

bool Zones::denied(ZoneFlag flag, const Vector3d& p_W) const {
  const std::vector<int>& candidates = flag == ZoneFlag::gps_denied ? gps_denied_ : radio_denied_;
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](int i) { return all_[static_cast<std::size_t>(i)].contains(p_W); });
}

int Zones::index_of(const std::string& name) const {
  for (std::size_t i = 0; i < all_.size(); ++i)
    if (all_[i].config().name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace sim
