// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/ode/ode_library.hpp"
#include "sim/physics/contact_report.hpp"
#include "sim/physics/contact_table.hpp"
#include "sim/physics/islands.hpp"
#include "sim/physics/motion.hpp"

namespace sim {

struct CollisionTerrain;

/// Properties of a part that the collider uses.
struct CollisionPart {
  dGeomID geom = nullptr;
  int body = -1;
  int group = -1;
  int material = 0;
  std::uint32_t category = 1;
  std::uint32_t collides_with = ~0u;
  const CollisionTerrain* terrain = nullptr;  ///< for a part of shape terrain: its material depends on position
};

/// Motion state of a body, used for the velocity of a contact point; all null for a fixed body.
struct CollisionBody {
  bool free = false;  ///< neither fixed nor kinematic
  dBodyID ode = nullptr;
  const dReal* position = nullptr;
  const dReal* velocity = nullptr;
  const dReal* angular_velocity = nullptr;
  double inverse_mass = 0;
};

/// Finds the parts in contact and makes contact joints.
///
/// The order of contacts affects the last bits of a step, and each kind of space has its own order.  Pairs are
/// therefore collected first, with the lower part number first, then sorted, and only then tested in detail.
class Collider {
 public:
  Collider(const PhysicsConfig& config, ContactTable table);

  // The caller assigns the numbers of groups, bodies and parts, and may reuse those of removed ones.
  /// Adds an empty group with its own collision space.
  void add_group(int group, bool self_collision);
  /// Adds the geom to the space of its group.  A moving geom must be attached to its body and have its pose.
  void add_part(int number, const CollisionPart& part, GeomHandle geom, Motion motion);
  /// Adds a body, whose pointers must stay valid until remove_group.
  void add_body(int number, const CollisionBody& body);
  /// Excludes contacts between two bodies connected by a joint.
  void join(int first, int second);
  /// Adds the space and the fixed parts of the group to the world's space.
  void close_group(int group);
  /// Destroys the geoms of all parts of a group.  Call before its ODE bodies are destroyed.
  void remove_group(int group, std::span<const int> bodies, std::span<const int> parts);

  void add_surfaces(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts) {
    table_.add(materials, contacts);
  }
  void set_gravity(double gravity_mps2);
  /// Maximum penetration of the parts of a group into the parts of another group; group -1: none.
  struct Overlap {
    int group = -1;
    double depth_m = 0;
  };
  Overlap deepest_overlap(int group) const;

  /// Start and stop recording the contacts of a group in each step.  Calls are counted: a group can have several
  /// watchers.
  void watch(int group);
  void unwatch(int group);
  /// Returns the forces of the watched contacts of this step.  Call after the solver and before the contact joints are
  /// destroyed.
  void read_forces(std::vector<ContactReport>& reports) const;

  /// Makes the contact joints of a step and adds their rows to the islands; returns the number of contacts.
  int collide(dWorldID world, dJointGroupID contacts, Islands& islands);

  const ContactTable& table() const { return table_; }
  const std::vector<CollisionPart>& parts() const { return parts_; }

 private:
  struct Group {
    SpaceHandle space;
    std::vector<dGeomID> fixed;  // until close_group adds them to the world's space
    bool self_collision = false;
    int watchers = 0;
  };
  /// A contact joint of this step whose force is requested.
  struct WatchedContact {
    dJointID joint;
    ContactReport report;
    bool turned;  // ODE's first body belongs to the second part
  };

  const Surface& surface_at(const CollisionPart& a, const CollisionPart& b, const dContactGeom& contact) const;
  static void on_near(void* self, dGeomID first, dGeomID second);
  void add_pair(int first, int second);
  void sort_pairs();
  int touch(int first, int second, dWorldID world, dJointGroupID contacts, Islands& islands);
  bool watched(const CollisionPart& a, const CollisionPart& b) const {
    return groups_[a.group].watchers > 0 || groups_[b.group].watchers > 0;
  }
  void follow_ground(dContact& contact) const;
  void align_friction(dContact& contact, const CollisionBody& a, const CollisionBody& b) const;
  bool free(const CollisionPart& part) const { return bodies_[part.body].free; }

  ContactTable table_;
  double step_s_;
  double surface_layer_m_;
  double gravity_mps2_;
  double still_mps_;  // below this slip speed friction has no direction
  SpaceHandle space_;
  std::vector<Group> groups_;
  std::vector<GeomHandle> geoms_;
  std::vector<CollisionPart> parts_;
  std::vector<CollisionBody> bodies_;
  std::vector<std::vector<int>> joined_;  // by body: bodies joined to it
  std::vector<std::uint64_t> pairs_, sorted_;
  std::vector<std::uint32_t> starts_;
  std::vector<dContact> touching_;
  int watchers_ = 0;  // of all groups
  std::vector<WatchedContact> watched_;
  std::vector<dJointFeedback> feedback_;  // of watched_; sized once per step because ODE keeps pointers to it
};

}  // namespace sim
