// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/collision/contact_report.hpp"
#include "sim/collision/motion.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/joint.hpp"
#include "sim/physics/physics_types.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

class StateArchive;

/// Rigid bodies, joints and contacts, stepped by ODE.  It has no notion of vehicles or devices: each vehicle or object
/// is a group, whose parts share one collision space.
///
/// Groups can be added and removed between any two steps.  Groups, bodies, joints and parts have numbers; those of
/// removed ones are reused, the lowest first, so that memory does not grow with additions and removals.
class PhysicsWorld {
 public:
  /// Makes an empty world.  Names in `contacts` must be materials; `categories` are the names of part categories (at
  /// most 31; `solid` always exists).  The names were checked when the files were read.
  PhysicsWorld(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
               const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
               std::uint64_t seed);
  ~PhysicsWorld();
  PhysicsWorld(const PhysicsWorld&) = delete;
  PhysicsWorld& operator=(const PhysicsWorld&) = delete;

  /// Adds a group, for a vehicle or an object, and returns its number.  Parts of a group collide with each other only
  /// when `self_collision` is true.
  int add_group(const std::string& name, bool self_collision = false);
  /// Creates a body whose mass, center of mass and inertia are computed from its parts.  X_WV: pose of the vehicle or
  /// object.  A body that is fixed or kinematic needs no mass and has none.  Throws ConfigError (mesh files; no mass).
  Body& add_body(int group, const BodyConfig& config, const Pose& X_WV, Motion motion = Motion::free);
  /// Creates a joint between bodies of this group; `second` null: the world.  The present poses of the bodies are the
  /// zero of the joint.  Throws ConfigError when neither body is free.
  Joint& add_joint(int group, const JointConfig& config, Body& first, Body* second, const Pose& X_WV);
  /// Completes a group: adds its fixed parts to the world's space.  Call after its last body.
  void close_group(int group);
  /// Destroys the joints, bodies and parts of a group; references to them, watches and contact reports of it become
  /// invalid.  Rays and contacts no longer find it.  Throws std::out_of_range when the group does not exist.
  void remove_group(int group);
  /// Moves all bodies of a group together: X_WB := X_move_W * X_WB.  The world side of its joints moves too, so that
  /// joints keep their positions.  Velocities are rotated, or become zero.
  void move_group(int group, const Pose& X_move_W, bool keep_velocity = false);

  // Functions that rebuild a world as it was after additions and removals.
  GroupNumbers numbers_of(int group) const;
  /// Assigns these numbers to the next group and its bodies, parts and joints.  Throws std::out_of_range when one is in
  /// use.
  void prescribe(const GroupNumbers& numbers);
  /// Whether all prescribed numbers have been assigned.
  bool as_prescribed() const;
  /// Creation poses of the joints of a group to the world, in their order.
  std::vector<JointPlace> joint_places(int group) const;
  /// Creates these joints again at the given places; bodies do not move.  Throws std::out_of_range when the number of
  /// places differs from the number of joints.
  void make_joints_again(int group, std::span<const JointPlace> places);

  /// Returns the name of the group that a group penetrates most, and the depth in m; empty: none.
  std::pair<std::string, double> deepest_overlap(int group) const;

  /// Returns a warning line for each pair of terrain and part that is known to give poor contact or a high cost, in
  /// order of the terrain; parts of equal shape and size are reported once.  See docs/models/terrain.md.
  std::vector<std::string> ground_warnings() const;

  /// Adds materials and contacts.  New materials get new, stable numbers.  The contacts given to the constructor take
  /// precedence over these, and among these the last one.  Known materials and equal contacts are ignored.
  void add_surfaces(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  /// Adds part categories; known names are ignored.  Throws std::length_error over 31, and then none is added.
  void add_categories(const std::vector<std::string>& names);
  /// Sets gravity, positive downwards, from the next step on.
  void set_gravity(double gravity_mps2);
  double gravity_mps2() const;  ///< positive downwards

  /// Sets the number of threads of a step; 0: one for each processor.  Results do not depend on it.
  void use_threads(int threads);

  /// Advances by one step of `config.step_s`: collide, solve, check.  Throws PhysicsFault with the name of the body.
  void step(std::int64_t step_number);

  /// Returns the free bodies that have moved further than their size in a step since the last call, each once, unless
  /// nothing was near them: contacts are only found where parts overlap at the end of a step.
  std::vector<Leap> take_leaps();

  /// Start and stop the report of a group's contacts by contacts(), from the next step on.  Calls are counted: each
  /// watch_contacts needs one unwatch_contacts.
  void watch_contacts(int group);
  void unwatch_contacts(int group);
  /// Contacts of the watched groups in the last step, ordered by the numbers of their parts.  Watching does not change
  /// the run.
  std::span<const ContactReport> contacts() const;

  /// Scene for ray casting.
  const Scene& scene() const;
  /// Bodies by number; null where a body was removed.
  std::span<const std::unique_ptr<Body>> bodies() const;
  /// Joints by number; null where a joint was removed.
  std::span<const std::unique_ptr<Joint>> joints() const;
  /// Parts by number; a removed part has group -1.
  std::span<const PartInfo> parts() const;
  /// Number of a part by its name in the group, such as `chassis/hull`; a part without a name has its index in the
  /// body, from 1, as its name.
  std::optional<int> find_part(int group, std::string_view body_slash_part) const;
  int materials() const;  ///< number of materials
  /// Material by number, such as RayHit::material; number 0 is `default`.
  const MaterialConfig& material(int number) const;
  /// Pose of a part.
  Pose X_WP(int part) const;
  /// Axis-aligned bounding box of a part in the world; empty for a plane.  Not thread-safe.
  std::optional<Eigen::AlignedBox3d> bounds_W(int part) const;
  /// Name of a group; empty when the group was removed.
  const std::string& group_name(int group) const;
  /// Counts of the last step.
  const StepCounts& last_step() const;
  /// Returns the island (bodies connected by joints and contacts) with the most constraint rows in the last step, which
  /// takes the most time.  Visits each body.
  IslandInfo largest_island() const;
  /// Number of steps with an island too large for WorldStep, or on which WorldStep gave up.
  std::int64_t quick_steps() const;
  /// Bit of a category name.  Throws std::out_of_range.
  std::uint32_t category_bit(const std::string& name) const;
  double step_s() const;
  /// Whether a joint of the group is attached to the world.
  bool anchored(int group) const;
  /// Saves, hashes or restores the state outside bodies and joints: gravity, contacts of the last step, counts.
  void visit_state(StateArchive& archive);
  /// Replaces the content by a new world at the same address; everything in the old one is destroyed.
  void start_again(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                   const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                   std::uint64_t seed);

 private:
  int threads_ = 1;
  void discard();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
