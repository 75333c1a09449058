// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/parts.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "sim/collision/ground_check.hpp"

namespace sim {

void Parts::add_categories(const std::vector<std::string>& names) {
  std::vector<std::string> all = categories_;
  for (const std::string& name : names)
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  if (all.size() > 31) throw std::length_error("more than 31 categories of parts");
  categories_ = std::move(all);
}

std::uint32_t Parts::category_bit(const std::string& name) const {
  const auto at = std::find(categories_.begin(), categories_.end(), name);
  if (at == categories_.end()) throw std::out_of_range("unknown category '" + name + "'");
  return 1u << (at - categories_.begin());
}

std::uint32_t Parts::category_bits(const std::vector<std::string>& names) const {
  if (names.empty()) return ~0u;
  std::uint32_t bits = 0;
  for (const std::string& name : names) bits |= category_bit(name);
  return bits;
}

std::vector<int> Parts::add(SteppedBody& body, const BodyConfig& config, Collider& collider, WorldScene& scene) {
  std::vector<NewPart> made;
  dMass total;
  dMassSetZero(&total);
  for (std::size_t i = 0; i < config.parts.size(); ++i) {
    const PartConfig& part = config.parts[i];
    const std::string who =
        "body '" + body.name() + "': part " + (part.name.empty() ? std::to_string(i + 1) : "'" + part.name + "'");
    made.push_back(make(body, part, who, collider.table()));
    if (!body.free()) continue;
    const dMass mass = part_mass(part, made.back().mesh, who);
    if (mass.mass > 0) dMassAdd(&total, &mass);
  }
  if (body.free()) body.set_mass(config, total);
  std::vector<int> numbers;
  for (std::size_t i = 0; i < made.size(); ++i)
    numbers.push_back(add(body, config.parts[i], i, std::move(made[i]), collider, scene));
  return numbers;
}

Parts::NewPart Parts::make(const Body& body, const PartConfig& part, const std::string& who,
                           const ContactTable& table) {
  if (!shape_info(part.shape).solid && !body.fixed())
    throw_config_error(part.place, who,
                       "a " + std::string(word_of(part_shape_words, part.shape)) + " can only be part of a fixed body");
  NewPart made;
  if (part.shape == PartShape::terrain) {
    made.terrain = std::make_unique<CollisionTerrain>(part, who, table, meshes_);
    made.geom = make_terrain_geom(*made.terrain);
  } else {
    made.mesh = part.shape == PartShape::mesh ? &meshes_.get(part, who) : nullptr;
    made.geom = make_geom(part, made.mesh);
  }
  return made;
}

int Parts::add(SteppedBody& body, const PartConfig& part, std::size_t index, NewPart made, Collider& collider,
               WorldScene& scene) {
  const dGeomID geom = made.geom.get();
  const Pose X_BG = make_pose(part.position_m, part.rpy_rad);
  body.add_geom(geom, part, X_BG);
  // Number and describe the part.
  const CollisionPart collision{geom,
                                body.number(),
                                body.group(),
                                collider.table().number_of(part.material),
                                category_bit(part.category),
                                category_bits(part.collides_with),
                                made.terrain.get()};
  const int number = numbers_.take();
  const std::string name = part.name.empty() ? std::to_string(index + 1) : part.name;
  slot(parts_, number) = {
      body.name() + "/" + name, body.group(), body.number(),           collision.material,
      collision.category,       X_BG,         parse_color(part.color), part.shape == PartShape::plane};
  // Add it to the scene and the collider.
  ScenePart seen{geom,
                 body.group(),
                 collision.category,
                 collision.material,
                 collider.table().material(collision.material).transmits(),
                 !body.fixed(),
                 made.mesh != nullptr ? &made.mesh->mesh : nullptr,
                 {}};
  if (made.terrain) {
    seen.mesh = &made.terrain->mesh;
    seen.triangle_materials = made.terrain->triangle_materials;
  }
  scene.add_part(number, seen);
  collider.add_part(number, collision, std::move(made.geom), body.motion_kind());
  if (made.terrain) terrains_[number] = std::move(made.terrain);
  return number;
}

void Parts::remove(const std::vector<int>& numbers) {
  for (const int number : numbers) {
    terrains_.erase(number);
    parts_[static_cast<std::size_t>(number)] = {};
    numbers_.give_back(number);
  }
}

const CollisionTerrain* Parts::terrain(int number) const {
  const auto at = terrains_.find(number);
  return at == terrains_.end() ? nullptr : at->second.get();
}

namespace {

/// ODE bodies on joints that can carry a wheel; never iterated, as the order of pointers varies.
std::set<dBodyID> find_hinged(const Groups& groups) {
  std::set<dBodyID> hinged;
  for (std::size_t number = 0; number < groups.joints().size(); ++number) {
    if (!groups.joints()[number]) continue;
    const SteppedJoint& joint = groups.joint(static_cast<int>(number));
    if (!joint_info(joint.type()).carries_a_wheel) continue;
    for (const int end : {0, 1}) hinged.insert(dJointGetBody(joint.ode(), end));
  }
  return hinged;
}

}  // namespace

std::vector<std::string> Parts::ground_warnings(const Groups& groups, const Collider& collider) const {
  if (terrains_.empty()) return {};
  const std::set<dBodyID> hinged = find_hinged(groups);
  std::set<int> angular;  // bodies with parts other than spheres and cylinders: not wheels
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (parts_[i].group >= 0 && !is_round(collider.parts()[i].geom)) angular.insert(parts_[i].body);
  // Check each free part on each terrain.
  std::vector<std::string> warnings;
  for (const auto& [number, ground] : terrains_) {
    std::map<std::string, std::pair<std::string, int>> named;  // by warning: name of the first part, number of parts
    const CollisionPart& under = collider.parts()[static_cast<std::size_t>(number)];
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const CollisionPart& part = collider.parts()[i];
      if (parts_[i].group < 0 || !groups.body(part.body).free()) continue;
      if ((part.category & under.collides_with) == 0 || (under.category & part.collides_with) == 0) continue;
      GroundContact contact{part.geom, hinged.contains(dGeomGetBody(part.geom)) && !angular.contains(part.body), false};
      for (const int material : ground->area_materials)
        contact.hard |= (collider.table().of(part.material, material).parameters.mode & dContactSoftCFM) == 0;
      for (std::string& warning : warnings_about(*ground, contact)) {
        auto& [first, count] = named[std::move(warning)];
        if (count++ == 0) first = parts_[i].name;
      }
    }
    // Report equal warnings once.
    for (const auto& [warning, parts] : named)
      warnings.push_back("terrain '" + (*this)[number].name + "' under '" + parts.first + "'" +
                         (parts.second > 1 ? " and " + std::to_string(parts.second - 1) + " more" : "") + ": " +
                         warning);
  }
  return warnings;
}

}  // namespace sim
