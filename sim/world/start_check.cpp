// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/start_check.hpp"

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

namespace sim {

namespace {

/// Allowed penetration: objects that rest on the ground or on others penetrate by about a millimetre.
constexpr double allowed_m = 0.01;

/// Height above all terrain.
constexpr double highest_m = 12000;

/// Vehicle or free object with its initial pose.
struct Starter {
  std::string kind, name;
  SourcePlace place;
  int group = -1;
  Vector3d p_W = Vector3d::Zero();
};

std::vector<Starter> starters_of(const World& world, const std::map<std::string, SourcePlace>& places) {
  std::vector<Starter> starters;
  for (const auto& [name, object] : world.objects())
    if (!object.config.fixed && !object.config.kinematic)
      starters.push_back({"object", name, object.config.place, object.group, object.body->X_WB().translation()});
  for (const auto& vehicle : world.vehicles()) {
    const auto place = places.find(vehicle->name());
    starters.push_back({"vehicle", vehicle->name(), place == places.end() ? SourcePlace{} : place->second,
                        vehicle->group(), vehicle->base().X_WB().translation()});
  }
  return starters;
}

std::set<int> groups_of_terrain(const World& world) {
  std::set<int> groups;
  for (const auto& [name, object] : world.objects())
    if (std::any_of(object.config.parts.begin(), object.config.parts.end(),
                    [](const PartConfig& part) { return part.shape == PartShape::terrain; }))
      groups.insert(object.group);
  return groups;
}

/// Checks the initial pose of an entity.
class StartCheck {
 public:
  explicit StartCheck(const World& world) : world_(world), terrains_(groups_of_terrain(world)) {
    if (terrains_.empty()) return;
    const auto parts = world.physics().parts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto box = parts[i].group < 0 ? std::nullopt : world.physics().bounds_W(static_cast<int>(i));
      if (!box) continue;
      const auto [top, fresh] = tops_m_.emplace(parts[i].group, box->max().z());
      if (!fresh) top->second = std::max(top->second, box->max().z());
    }
  }

  std::string warning(const Starter& starter) {
    if (const std::string ground = terrain_over(starter); !ground.empty()) return "below the terrain of " + ground;
    const auto [other, depth_m] = world_.physics().deepest_overlap(starter.group);
    if (depth_m <= allowed_m) return "";
    // Report only one of two entities that penetrate each other.
    if (!warned_.insert(std::minmax(starter.name, other)).second) return "";
    return number_text(std::round(depth_m * 1000) / 1000) + " m deep in '" + other + "'";
  }

 private:
  std::string terrain_over(const Starter& starter) const {
    if (terrains_.empty()) return "";
    RayFilter others;
    others.exclude_group = starter.group;
    // The whole entity must be below: partial penetration of the ground is another error.
    const auto top = tops_m_.find(starter.group);
    if (top == tops_m_.end()) return "";
    const Vector3d from_W(starter.p_W.x(), starter.p_W.y(), top->second);
    const auto hit = world_.scene().cast(from_W, Vector3d::UnitZ(), highest_m, others);
    if (!hit) return "";
    const int group = world_.physics().parts()[static_cast<std::size_t>(hit->part)].group;
    return terrains_.contains(group) ? "'" + world_.physics().group_name(group) + "'" : "";
  }

  const World& world_;
  std::set<int> terrains_;
  std::map<int, double> tops_m_;  // the highest point of each group, in worlds with terrain
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
