#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "sim/physics/contact_table.hpp"
#include "sim/physics/islands.hpp"
#include "sim/physics/ode_library.hpp"

namespace sim {

/// What the collider needs to know of a part.
struct CollisionPart {
  dGeomID geom = nullptr;
  int body = -1;
  int group = -1;
  int material = 0;
  std::uint32_t category = 1;
  std::uint32_t collides_with = ~0u;
};

/// The moving state of a body, for the speed of a contact point; all null for a fixed body.
struct CollisionBody {
  dBodyID ode = nullptr;
  const dReal* position = nullptr;
  const dReal* velocity = nullptr;
  const dReal* angular_velocity = nullptr;
  double inverse_mass = 0;
};

/// Finds the parts that touch and makes contact joints.
///
/// The order of contacts decides the last bits of a step, and each kind of space has an order of its own.  So
/// pairs are collected first, the lower part number first, sorted, and only then looked at closely.
class Collider {
 public:
  Collider(const PhysicsConfig& config, ContactTable table);

  int add_group(bool self_collision);
  /// Takes the geom into its group's space.  A moving geom must be attached to its body and posed.
  int add_part(const CollisionPart& part, GeomHandle geom, bool moving);
  void add_body(const CollisionBody& body) { bodies_.push_back(body), joined_.emplace_back(); }
  /// Bodies joined by a joint do not collide.
  void join(int first, int second);
  void close_group(int group);

  /// Makes the contact joints of a step and counts their rows; returns how many.
  int collide(dWorldID world, dJointGroupID contacts, Islands& islands);

  const ContactTable& table() const { return table_; }
  const std::vector<CollisionPart>& parts() const { return parts_; }

 private:
  struct Group {
    SpaceHandle space;
    std::vector<dGeomID> fixed;  // wait for close_group
    bool self_collision = false;
  };

  static void on_near(void* self, dGeomID first, dGeomID second);
  void add_pair(int first, int second);
  void sort_pairs();
  int touch(int first, int second, dWorldID world, dJointGroupID contacts, Islands& islands);
  void align_friction(dContact& contact, const CollisionBody& a, const CollisionBody& b) const;
  bool moving(const CollisionPart& part) const { return bodies_[part.body].ode != nullptr; }

  ContactTable table_;
  double step_s_;
  double gravity_mps2_;
  double still_mps_;  // slower slip has no direction worth following
  SpaceHandle space_;
  std::vector<Group> groups_;
  std::vector<GeomHandle> geoms_;
  std::vector<CollisionPart> parts_;
  std::vector<CollisionBody> bodies_;
  std::vector<std::vector<int>> joined_;  // by body: bodies joined to it
  std::vector<std::uint64_t> pairs_, sorted_;
  std::vector<std::uint32_t> starts_;
  std::vector<dContact> touching_;
};

}  // namespace sim
