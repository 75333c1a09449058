// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/collision/body_places.hpp"
#include "sim/collision/contact_report.hpp"
#include "sim/collision/contact_table.hpp"
#include "sim/collision/islands.hpp"
#include "sim/collision/motion.hpp"
#include "sim/geometry/box_grid.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/rays/world_scene.hpp"

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
  bool wheel = false;                         ///< a cylinder or capsule that turns about its axis
  double carried_kg = 0;                      ///< by a wheel: its share of the mass of its group
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
/// therefore collected first, with the lower part number first, then sorted by the caller, and only then tested in
/// detail.
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
  /// Replaces the ODE body of a body.
  void replace_body(int number, const CollisionBody& body) { bodies_[static_cast<std::size_t>(number)] = body; }
  /// Excludes contacts between two bodies connected by a joint.
  void join(int first, int second);
  /// Makes those cylinders and capsules among the parts wheels that turn about the axis of a joint.
  void find_wheels(std::span<const int> parts, const Vector3d& at_W, const Vector3d& axis_W);
  /// Shares a mass among the wheels of these parts.
  void load_wheels(std::span<const int> parts, double mass_kg);
  /// Adds the space and the fixed parts of the group to the world's space.
  void close_group(int group);
  /// Takes a group that can touch nothing out of the world's space, or brings it back.
  void set_far(int group, bool far);
  /// Distance of the farthest point of a moving body from its position; 0 without parts.
  double reach_m(int body) const { return places_.reach_m(body); }
  /// Boxes of all fixed parts, some of them infinite.
  std::vector<AlignedBox> fixed_boxes() const;
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
  /// `own_parts`: those of the group.
  Overlap deepest_overlap(int group, std::span<const int> own_parts, const SceneMoves& moves) const;
  /// Notes the position of a body after a step; threads may do so for different bodies.
  void note_position(int body) { places_.set_position(body, bodies_[static_cast<std::size_t>(body)].position); }
  /// Declares that the positions of all bodies were noted since their last moves.
  void note_positions(const SceneMoves& moves) { noted_moves_ = moves.moving; }
  bool has_noted_positions(const SceneMoves& moves) const { return noted_moves_ == moves.moving; }

  /// Start and stop recording the contacts of a group in each step.  Calls are counted: a group can have several
  /// watchers.
  void watch(int group);
  void unwatch(int group);

  /// A pair of parts whose boxes overlap, the lower number first: `first << 32 | second`.
  using Pair = std::uint64_t;
  static int first_of(Pair pair) { return static_cast<int>(pair >> 32); }
  static int second_of(Pair pair) { return static_cast<int>(pair & 0xffffffff); }
  /// Finds the pairs of parts that may touch, in an order that has no meaning.
  const std::vector<Pair>& find_pairs();

  /// A contact joint whose force is requested.
  struct WatchedContact {
    dJointID joint;
    ContactReport report;
    bool turned;  ///< ODE's first body belongs to the second part
  };
  /// A contact between bodies of two groups, both of which can move.
  struct Between {
    dJointID joint;
    dContact contact;
    dBodyID bodies[2];
  };
  /// Where the contacts of some pairs are made.
  struct Making {
    /// Two at least: those on the rims of a wheel, of which one becomes.
    explicit Making(int max_contacts_per_pair)
        : max_per_pair(max_contacts_per_pair), touching(static_cast<std::size_t>(std::max(max_per_pair, 2))) {}
    int max_per_pair;
    JointGroupHandle contacts{dJointGroupCreate(0)};
    std::vector<dContact> touching;  ///< buffer of a pair
    std::vector<Between> between;    ///< contacts between groups
    int count = 0;
    std::vector<WatchedContact> watched;
    std::vector<dJointFeedback> feedback;  ///< of the watched ones
    int max_rows = 0;                      ///< of the islands that got contacts
  };
  /// Makes the contact joints of pairs, which must be sorted: the order of contacts affects the last bits of a step.
  /// Several threads may do so at once, for pairs without a common moving body.
  void make_contacts(std::span<const Pair> pairs, dWorldID world, Islands& islands, Making& making) const;
  /// Adds the watched contacts with their forces.  Call after the solver and before the contact joints are destroyed.
  static void read_forces(const Making& making, std::vector<ContactReport>& reports);

  const ContactTable& table() const { return table_; }
  const std::vector<CollisionPart>& parts() const { return parts_; }

 private:
  struct Group {
    SpaceHandle space;
    std::vector<dGeomID> fixed;  // until close_group adds them to the world's space
    bool self_collision = false;
    bool has_fixed = false;
    int watchers = 0;
  };
  const Surface& surface_at(const CollisionPart& a, const CollisionPart& b, const dContactGeom& contact) const;
  static void on_near(void* self, dGeomID first, dGeomID second);
  void add_pair(int first, int second);
  void touch(Pair pair, dWorldID world, Islands& islands, Making& making) const;
  int find_points(const CollisionPart& a, const CollisionPart& b, Making& making) const;
  bool watched(const CollisionPart& a, const CollisionPart& b) const {
    return groups_[a.group].watchers > 0 || groups_[b.group].watchers > 0;
  }
  void follow_ground(dContact& contact) const;
  void align_friction(dContact& contact, const CollisionBody& a, const CollisionBody& b) const;
  void ease_friction_across(dContact& contact, const CollisionBody& a, const CollisionBody& b, double load_N) const;
  bool free(const CollisionPart& part) const { return bodies_[part.body].free; }

  /// Parts near a group whose overlap is requested.
  struct OverlapIndex {
    SceneMoves moves;
    std::size_t changes = 0;
    bool built = false;
    BoxGrid grid;
    std::vector<int> parts;    ///< by number in the grid, ascending
    std::vector<int> endless;  ///< planes
  };

  // overlap.cpp
  void note_places(Group& closed);
  void discard_places(bool of_fixed_parts);
  void build_index() const;
  std::vector<int> parts_near(const AlignedBox& box) const;

  ContactTable table_;
  double step_s_;
  double surface_layer_m_;
  double gravity_mps2_;
  double still_mps_;  // below this slip speed friction has no direction
  SpaceHandle space_;
  std::vector<Group> groups_;
  std::vector<GeomHandle> geoms_;
  mutable BodyPlaces places_;              // of moving bodies of closed groups
  mutable std::uint64_t noted_moves_ = 0;  // when all their positions were noted
  std::vector<int> fixed_parts_;           // of closed groups
  std::size_t changes_ = 0;                // additions and removals of groups
  mutable OverlapIndex near_;
  mutable std::vector<AlignedBox> fixed_boxes_;  // of fixed_parts_; too few: to be renewed
  std::vector<CollisionPart> parts_;
  std::vector<CollisionBody> bodies_;
  std::vector<std::vector<int>> joined_;  // by body: bodies joined to it
  std::vector<Pair> pairs_;
  int watchers_ = 0;  // of all groups
};

}  // namespace sim
