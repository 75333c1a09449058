// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/free_numbers.hpp"
#include "sim/collision/collider.hpp"
#include "sim/collision/terrain_geom.hpp"
#include "sim/ode/part_shape.hpp"
#include "sim/physics/groups.hpp"
#include "sim/physics/physics_types.hpp"
#include "sim/rays/world_scene.hpp"

namespace sim {

/// The parts of all bodies: what they are, not whether they touch.  This class owns
/// - the descriptions of the parts and their free numbers,
/// - the names of the categories of parts, whose bits the collider compares,
/// - meshes and terrains.  ODE and the scene keep pointers into them, so it must outlive Collider and scene.
///
/// add() makes the parts of a new body: it checks them all before it adds the first one, so that an error in a file
/// leaves no incomplete body; it gives the body its mass; and it gives each geom to the collider, which owns it, and to
/// the scene.  The numbers of parts are those of the collider and of the scene.
///
/// A step only reads the lists, through Collider.  Nothing here is state: the numbers follow from the history of
/// additions and removals.
class Parts {
 public:
  /// Adds part categories; known names are ignored.  Throws std::length_error over 31, and then none is added.
  void add_categories(const std::vector<std::string>& names);
  /// Bit of a category name.  Throws std::out_of_range.
  std::uint32_t category_bit(const std::string& name) const;

  /// Adds the parts of a new body, and returns their numbers.  Throws ConfigError, see PhysicsWorld::add_body.
  std::vector<int> add(SteppedBody& body, const BodyConfig& config, Collider& collider, WorldScene& scene);
  /// Forgets parts whose geoms were destroyed.
  void remove(const std::vector<int>& numbers);
  /// Sets the numbers of the next parts.  Throws std::out_of_range when one is in use.
  void prescribe(const std::vector<int>& numbers) { numbers_.prescribe(numbers); }
  bool as_prescribed() const { return numbers_.as_prescribed(); }

  /// By number; a removed part has group -1.
  const std::vector<PartInfo>& all() const { return parts_; }
  const PartInfo& operator[](int number) const { return parts_[static_cast<std::size_t>(number)]; }
  /// The terrain of a part; null for other shapes.
  const CollisionTerrain* terrain(int number) const;
  /// See PhysicsWorld::ground_warnings.
  std::vector<std::string> ground_warnings(const Groups& groups, const Collider& collider) const;

 private:
  /// Checked part that is not yet in the world.
  struct NewPart {
    GeomHandle geom;
    const CollisionMesh* mesh = nullptr;
    std::unique_ptr<CollisionTerrain> terrain;
  };
  std::uint32_t category_bits(const std::vector<std::string>& names) const;
  NewPart make(const Body& body, const PartConfig& part, const std::string& who, const ContactTable& table);
  int add(SteppedBody& body, const PartConfig& part, std::size_t index, NewPart made, Collider& collider,
          WorldScene& scene);

  std::vector<std::string> categories_ = {"solid"};
  MeshCache meshes_;
  std::map<int, std::unique_ptr<CollisionTerrain>> terrains_;  // by part
  std::vector<PartInfo> parts_;
  FreeNumbers numbers_;
};

}  // namespace sim
