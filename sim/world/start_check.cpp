// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/message_text.hpp"
#include "sim/config/warnings.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_checks.hpp"

namespace sim {

namespace {

/// Allowed penetration: objects that rest on the ground or on others penetrate by about a millimeter.
constexpr double allowed_m = 0.01;

/// Height above all terrain.
constexpr double highest_m = 12000;

/// Height above the water from which on a craft falls noticeably.
constexpr double drop_m = 0.1;

/// Vehicle or free object with its initial pose.
struct Starter {
  std::string kind, name;
  SourcePlace place;
  int group = -1;
  Vector3d p_W = Vector3d::Zero();
  bool swims = false;  ///< a vehicle with hydrodynamic coefficients
};

std::string rounded(double value, double digits) {
  return number_text(std::round(value * digits) / digits);
}

std::vector<Starter> starters_of(const World& world, const std::map<std::string, SourcePlace>& places) {
  std::vector<Starter> starters;
  for (const auto& [name, object] : world.objects())
    if (!object.config->fixed && !object.config->led())
      starters.push_back({"object", name, object.config->place, object.group(), object.base().X_WB().translation()});
  for (const auto& vehicle : world.vehicles()) {
    const auto place = places.find(vehicle->name());
    starters.push_back({"vehicle", vehicle->name(), place == places.end() ? SourcePlace{} : place->second,
                        vehicle->group(), vehicle->base().X_WB().translation(), vehicle->config().has_coefficients()});
  }
  return starters;
}

std::set<int> groups_of_terrain(const World& world) {
  std::set<int> groups;
  for (const auto& [name, object] : world.objects())
    if (object.config->any_part([](const PartConfig& part) { return part.shape == PartShape::terrain; }))
      groups.insert(object.group());
  return groups;
}

/// Checks the initial pose of an entity.
class StartCheck {
 public:
  explicit StartCheck(const World& world) : world_(world), terrains_(groups_of_terrain(world)) {
    if (terrains_.empty() && !world.medium().has_water()) return;
    const auto parts = world.physics().parts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto box = parts[i].group < 0 ? std::nullopt : world.physics().bounds_W(static_cast<int>(i));
      if (!box) continue;
      const auto [height, fresh] = heights_m_.try_emplace(parts[i].group, box->min().z(), box->max().z());
      // Groups get one box over all their parts.
      if (fresh) continue;
      height->second.first = std::min(height->second.first, box->min().z());
      height->second.second = std::max(height->second.second, box->max().z());
    }
  }

  std::string warning(const Starter& starter) {
    if (const std::string ground = terrain_over(starter); !ground.empty()) return "below the terrain of " + ground;
    if (const double air_m = height_over_water_m(starter); air_m > drop_m)
      return rounded(air_m, 100) + " m above the water, and falls";
    const auto [other, depth_m] = world_.physics().deepest_overlap(starter.group);
    if (depth_m <= allowed_m) return "";
    // Report only one of two entities that penetrate each other.
    if (!warned_.insert(std::minmax(starter.name, other)).second) return "";
    return rounded(depth_m, 1000) + " m deep in '" + other + "'";
  }

 private:
  std::string terrain_over(const Starter& starter) const {
    if (terrains_.empty()) return "";
    RayFilter others;
    others.exclude_group = starter.group;
    // The whole entity must be below: partial penetration of the ground is another error.
    const auto height = heights_m_.find(starter.group);
    if (height == heights_m_.end()) return "";
    const Vector3d from_W(starter.p_W.x(), starter.p_W.y(), height->second.second);
    const auto hit = world_.scene().cast(from_W, Vector3d::UnitZ(), highest_m, others);
    if (!hit) return "";
    const int group = world_.physics().parts()[static_cast<std::size_t>(hit->part)].group;
    return terrains_.contains(group) ? "'" + world_.physics().group_name(group) + "'" : "";
  }

  /// Returns how far a craft falls before it touches the water; 0 when it does not swim, or something else is below it.
  double height_over_water_m(const Starter& starter) const {
    if (!starter.swims || !world_.medium().has_water() || world_.physics().anchored(starter.group)) return 0;
    const auto height = heights_m_.find(starter.group);
    const double low_m = height == heights_m_.end() ? starter.p_W.z() : height->second.first;
    // A craft that floats may start over the trough of a wave.
    const double surface_m = world_.medium().surface_m(starter.p_W.x(), starter.p_W.y());
    const double air_m = low_m - std::max(surface_m, world_.medium().still_surface_m());
    RayFilter others;
    others.exclude_group = starter.group;
    if (air_m <= drop_m ||
        world_.scene().cast(starter.p_W, -Vector3d::UnitZ(), starter.p_W.z() - low_m + air_m, others))
      return 0;
    return air_m;
  }

  const World& world_;
  std::set<int> terrains_;
  std::map<int, std::pair<double, double>> heights_m_;  // lowest and highest point of each group, with terrain or water
  std::set<std::pair<std::string, std::string>> warned_;
};

}  // namespace

void warn_of_starts(const World& world, Warnings& warnings) {
  std::map<std::string, SourcePlace> places;
  for (const VehicleInstance& vehicle : world.config().vehicles) places.emplace(vehicle.name, vehicle.place);
  StartCheck check(world);
  // Name the first vehicle of an entry with a `count`, and count the others.
  std::vector<std::pair<Starter, std::string>> first;
  std::map<std::string, int> more;
  for (const Starter& starter : starters_of(world, places)) {
    const std::string warning = check.warning(starter);
    if (warning.empty()) continue;
    const auto [at, fresh] = more.emplace(starter.place.line > 0 ? starter.place.text() : starter.name, 0);
    if (fresh)
      first.emplace_back(starter, warning);
    else
      ++at->second;
  }
  for (const auto& [starter, warning] : first) {
    const int others = more.at(starter.place.line > 0 ? starter.place.text() : starter.name);
    const std::string and_more = others > 0 ? " (and " + std::to_string(others) + " more of this entry)" : "";
    warnings.warn(starter.place, starter.kind + " '" + starter.name + "'", "it starts " + warning + and_more);
  }
}

}  // namespace sim
