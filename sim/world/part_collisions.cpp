// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/part_collisions.hpp"

#include <algorithm>

#include "sim/world/world.hpp"

namespace sim {

namespace {

bool accepts(const std::vector<std::string>& categories, const std::string& category) {
  return categories.empty() || std::find(categories.begin(), categories.end(), category) != categories.end();
}

}  // namespace

PartCollisions::PartCollisions(const World& world) {
  for (const auto& vehicle : world.vehicles()) add(vehicle->config(), vehicle->name());
  for (const auto& [name, object] : world.objects()) add(*object.config, name);
}

void PartCollisions::add(const MechanismConfig& config, const std::string& owner) {
  for (const BodyConfig& body : config.bodies)
    for (const PartConfig& part : body.parts) add(part, owner, config.self_collision);
}

void PartCollisions::add(const PartConfig& part, const std::string& owner, bool self_collision) {
  auto kind = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& each) {
    return each.category == part.category && each.collides_with == part.collides_with;
  });
  if (kind == kinds_.end()) kind = kinds_.insert(kind, Kind{part.category, part.collides_with, {}, {}});
  if (kind->owners.size() < 2) kind->owners.insert(owner);
  if (self_collision) kind->with_self.insert(owner);
}

bool PartCollisions::has(const PartConfig& part, const std::string& owner) const {
  return part.collides_with.empty() || std::any_of(kinds_.begin(), kinds_.end(), [&](const Kind& kind) {
           const bool other =
               kind.owners.size() > (kind.owners.contains(owner) ? 1U : 0U) || kind.with_self.contains(owner);
           return other && accepts(part.collides_with, kind.category) && accepts(kind.collides_with, part.category);
         });
}

}  // namespace sim
