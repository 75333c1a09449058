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
#include "sim/model/physics_config.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/contact_report.hpp"
#include "sim/physics/joint.hpp"
#include "sim/physics/motion.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

class StateArchive;

/// One part as built: its owner.
struct PartInfo {
  std::string name;
  int group = -1;    ///< -1: the part was removed, and nothing else here means anything
  int body = -1;     ///< number in PhysicsWorld::bodies()
  int material = 0;  ///< see PhysicsWorld::material
  std::uint32_t category = 1;
  Pose X_BP = Pose::Identity();  ///< of the part in its body
  std::optional<Color> color;    ///< of its own; else the material's
  bool plane = false;            ///< has no end
};

/// The numbers of a group and of what belongs to it, in the order in which they came.
struct GroupNumbers {
  int group = -1;
  std::vector<int> bodies, parts, joints;
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(group, bodies, parts, joints);
  }
};

/// Where a joint to the world was made: ODE counts from there.
struct JointPlace {
  Pose X_WV = Pose::Identity();
  Pose X_WC = Pose::Identity();  ///< of the body that moves
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(X_WV, X_WC);
  }
};

/// Work done by the last step, the same in every run.
struct StepCounts {
  int contacts = 0;
  int max_island_rows = 0;
  bool quick = false;  ///< QuickStep was used
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(contacts, max_island_rows, quick);
  }
};

/// Bodies that were solved together.
struct IslandInfo {
  int rows = 0;                     ///< of constraints
  std::vector<std::string> bodies;  ///< by number; of very many the first 1000
  std::size_t body_count = 0;
};

/// Rigid bodies, joints and contacts, stepped by ODE.  Knows no vehicle and no device: a vehicle or an object is a
/// group, whose parts share one collision space.
///
/// Groups can come and go between any two steps.  Groups, bodies, joints and parts have numbers; those of removed
/// ones are reused, the lowest first, so that a world with many additions and removals does not grow.
class PhysicsWorld {
 public:
  /// Names in `contacts` must be materials; `categories` are the names of part categories (at most 31; `solid` is
  /// always there).  Names were checked when the files were read.
  PhysicsWorld(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
               const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
               std::uint64_t seed);
  ~PhysicsWorld();
  PhysicsWorld(const PhysicsWorld&) = delete;
  PhysicsWorld& operator=(const PhysicsWorld&) = delete;

  /// A vehicle or an object.  Parts of a group collide with each other only when `self_collision`.
  int add_group(const std::string& name, bool self_collision = false);
  /// Builds a body whose mass, centre of mass and inertia are computed from its parts.  X_WV: pose of the vehicle or
  /// object.  A body that is fixed or kinematic needs no mass and has none.  Throws ConfigError (mesh files; no mass).
  Body& add_body(int group, const BodyConfig& config, const Pose& X_WV, Motion motion = Motion::free);
  /// Between bodies of this group; `second` null: the world.  At the pose the bodies have now, which is the joint's
  /// zero.  Throws ConfigError when neither body is free.
  Joint& add_joint(int group, const JointConfig& config, Body& first, Body* second, const Pose& X_WV);
  /// Ends a group: puts its parts into the world's space.  Call after its last body.
  void close_group(int group);
  /// Destroys joints, bodies and parts of a group; references to them, watches and contact reports of it end here. Rays
  /// and contacts do not find it any more.  Throws std::out_of_range when there is no such group.
  void remove_group(int group);
  /// Moves all bodies of a group as one: X_WB := X_move_W * X_WB, the world's side of its joints too, so that joints
  /// keep their positions.  Velocities turn along, or become zero.
  void move_group(int group, const Pose& X_move_W, bool keep_velocity = false);

  // For who builds a world again as it became.
  GroupNumbers numbers_of(int group) const;
  /// The next group, and what is added to it, get these numbers.  Throws std::out_of_range when one is in use.
  void prescribe(const GroupNumbers& numbers);
  /// All numbers that were prescribed have been given.
  bool as_prescribed() const;
  /// Of the joints of a group that hold on to the world, in their order.
  std::vector<JointPlace> joint_places(int group) const;
  /// Makes them again there; bodies stay where they are.  Throws std::out_of_range when they are not so many.
  void make_joints_again(int group, std::span<const JointPlace> places);

  /// Names the group that a group stands deepest in, and how deep; empty: in none.
  std::pair<std::string, double> deepest_overlap(int group) const;

  /// Pairs of terrain and parts on it that are known to drive badly or to cost much, a line each, in order of the
  /// terrain; parts of equal shape and size are named once.  See docs/models/terrain.md.
  std::vector<std::string> ground_warnings() const;

  /// New materials get new numbers, and keep them.  What the constructor got wins over these contacts, and of these
  /// the last one wins.  Materials known already and equal contacts are ignored.
  void add_surfaces(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  /// Known names are ignored.  Throws std::length_error over 31, and then none was added.
  void add_categories(const std::vector<std::string>& names);
  /// Downwards, from the next step on.
  void set_gravity(double gravity_mps2);
  double gravity_mps2() const;  ///< now, downwards

  /// One step of `config.step_s`: collide, solve, check.  Throws PhysicsFault naming the body.
  void step(std::int64_t step_number);

  /// From the next step on contacts() reports this group.  Counted: as many calls of unwatch_contacts end it.
  void watch_contacts(int group);
  void unwatch_contacts(int group);
  /// The contacts of the last step in which a watched group takes part, ordered by the numbers of their parts. Watching
  /// does not change the run.
  std::span<const ContactReport> contacts() const;

  const Scene& scene() const;
  /// By number; null where a body was removed.
  std::span<const std::unique_ptr<Body>> bodies() const;
  /// By number; null where a joint was removed.
  std::span<const std::unique_ptr<Joint>> joints() const;
  /// By number; a removed part has group -1.
  std::span<const PartInfo> parts() const;
  /// Number of a part by its name in the group, such as `chassis/hull`; a part without a name is called by its place in
  /// the body, from 1.
  std::optional<int> find_part(int group, std::string_view body_slash_part) const;
  int materials() const;  ///< how many there are
  /// Number 0 is `default`; where a ray hit: RayHit::material.
  const MaterialConfig& material(int number) const;
  /// Where a part is now.
  Pose X_WP(int part) const;
  /// A box around a part, along the axes of the world; empty for a plane.  Not from several threads.
  std::optional<Eigen::AlignedBox3d> bounds_W(int part) const;
  /// Empty when the group was removed.
  const std::string& group_name(int group) const;
  const StepCounts& last_step() const;
  /// The island (bodies connected by joints and contacts) with the most constraint rows in the last step, which takes
  /// the most time.  Looks at each body.
  IslandInfo largest_island() const;
  /// Steps in which QuickStep stood in for WorldStep because an island was too large.
  std::int64_t quick_steps() const;
  /// Bit of a category name.  Throws std::out_of_range.
  std::uint32_t category_bit(const std::string& name) const;
  double step_s() const;
  /// A joint of the group holds on to the world.
  bool anchored(int group) const;
  /// What is neither a body's nor a joint's: gravity, contacts of the last step, counts.
  void visit_state(StateArchive& archive);
  /// Becomes another world of the same place in memory.  What was in it is gone.
  void start_again(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                   const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                   std::uint64_t seed);

 private:
  void discard();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
