// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/free_numbers.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/collision/collider.hpp"
#include "sim/collision/group_boxes.hpp"
#include "sim/collision/islands.hpp"
#include "sim/collision/terrain_geom.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/ode/part_shape.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/physics/shard.hpp"
#include "sim/rays/world_scene.hpp"

namespace sim {

// Members are destroyed from the last to the first: joints and bodies before their world.
struct PhysicsWorld::Impl {
  /// Bodies, parts and joints of a group, by number.
  struct Group {
    std::string name;
    bool in_use = false;
    std::vector<int> bodies, parts, joints;
    std::vector<Body*> moving;  ///< free and kinematic
    int shard = -1;             ///< none without moving bodies
    bool anchored = false;      ///< a joint connects it to the world
  };
  /// Shard that is one body without joints.
  struct Single {
    Body* body;
    int shard;
  };

  Impl(const PhysicsConfig& config_, ContactTable table, std::uint64_t seed_)
      : config(config_), seed(seed_), collider(config_, std::move(table)) {
    moves.bring_parts = [this] { bring_parts(); };
  }

  PhysicsConfig config;
  std::uint64_t seed;
  std::vector<std::string> categories = {"solid"};
  MeshCache meshes;
  std::map<int, std::unique_ptr<CollisionTerrain>> terrains;  // by part; outlive the geoms of collider and scene
  std::vector<std::unique_ptr<ShardStepper>> steppers, spoiled_steppers;  // not used now; of steps that failed
  std::mutex steppers_mutex;
  std::vector<std::unique_ptr<Shard>> shards;  // by the group with the lowest number in it
  std::vector<int> shard_of_part;              // -1: on a fixed body
  Collider collider;
  Islands islands;
  std::vector<Group> groups;
  std::vector<PartInfo> parts;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Joint>> joints;
  FreeNumbers group_numbers, part_numbers, body_numbers, joint_numbers;
  std::vector<ContactReport> contact_reports;
  double gravity_mps2 = config.gravity_mps2;
  bool gravity_was_set = false;  ///< set_gravity() was called
  SceneMoves moves;
  std::unique_ptr<WorldScene> scene;
  std::vector<Shard*> filled_;  // shards that this step steps by ODE
  // single_bodies.cpp
  std::vector<Single> singles;
  std::vector<int> other_shards;    // by number
  std::vector<char> steps_by_ode;   // by shard: whether it has pairs, or steps by ODE for another reason
  std::vector<Body*> near_singles;  // with parts, in the collision space
  bool shards_listed = false, near_singles_known = false;
  bool parts_behind = false;  ///< parts of single bodies are not marked as moved
  // ground_check.cpp
  std::vector<int> may_leap;  // bodies, in the order of the threads
  std::vector<Leap> leaps;
  // far_group_boxes.cpp
  GroupBoxes far_groups;
  std::vector<int> left_boxes;  // new groups, and those of bodies that left the box; several times the same
  std::mutex left_mutex;
  bool fixed_parts_changed = true;                   ///< some were added or removed
  std::uint64_t far_fixed_moves = 0, far_jumps = 0;  // at the last update
  double far_horizon_s = 1;                          ///< for which a box suffices at constant speed
  int steps_without_far_groups = 0;
  StepCounts counts;
  std::int64_t quick_steps = 0;
  bool broken = false;                  ///< ODE threw an error within a step
  std::unique_ptr<ThreadPool> threads;  ///< null: one thread

  std::uint32_t category_bit(const std::string& name) const;
  std::uint32_t category_bits(const std::vector<std::string>& names) const;
  Group& group(int number);
  void attach_ode_body(Body& body, dWorldID world);
  void add_parts(Body& body, const BodyConfig& config);
  /// Checked part that is not yet in the world.
  struct NewPart {
    GeomHandle geom;
    const CollisionMesh* mesh = nullptr;
    std::unique_ptr<CollisionTerrain> terrain;
  };
  NewPart make_part(const Body& body, const PartConfig& part, const std::string& who);
  void add_part(Body& body, const BodyConfig& config, std::size_t index, NewPart made);
  void set_mass(Body& body, const BodyConfig& config, const dMass& total);
  CollisionBody collision_body(const Body& body) const;
  void find_wheels(const JointConfig& hinge, const Body& first, const Body* second, const Pose& X_WV);
  // shards.cpp
  Shard& shard(int number);
  void deal_pairs(std::int64_t step_number);
  bool some_share_a_shard() const;
  void place_groups(const std::vector<Collider::Pair>& pairs, bool separate);
  void fill_shard(int number, const std::vector<int>& desired);
  void move_to_shard(int number, int to);
  void leave_shard(int number);
  // far_group_boxes.cpp
  std::optional<AlignedBox> make_box(const Group& group);
  void find_far_groups();
  void update_far_groups();
  void note_group(int number);
  // single_bodies.cpp
  void list_shards();
  bool step_singles();
  void step_by_ode_without_pairs(int shard);
  void mark_near_singles();
  void bring_parts();
  static void mark_as_moved(const Body& body);
  void note_left_boxes(const std::vector<int>& left);
  // ground_check.cpp
  void plan_leaps(const Group& group);
  void plan_leaps_anew();
  void note_may_leap(const std::vector<int>& fast);
  void find_leaps();
  // shard_step.cpp
  void step_shards(std::int64_t step_number);
  void step_shard(Shard& shard, ShardStepper& stepper, std::int64_t step_number);
  bool step_lone_bodies(const Shard& shard, ShardStepper& stepper);
  void solve(Shard& shard, ShardStepper& stepper, std::int64_t step_number);
  void step_islands_by_size(Shard& shard, ShardStepper& stepper, std::int64_t step_number);
  bool is_large(const Body& body);
  void step_exactly(Shard& shard, ShardStepper& stepper, std::int64_t step_number);
  template <class IslandOf>
  void step_or_fall_back(Shard& shard, ShardStepper& stepper, std::int64_t step_number, const IslandOf& island_of);
  void list_content(Shard& shard);
  template <class Visit>
  void for_each_moving(const Visit& visit) const {
    for (const Group& group : groups)
      for (Body* body : group.moving) visit(*body);
  }
  std::string suspects(const Shard& shard);
  bool out_of_bounds(const Body& body) const;
  [[noreturn]] void fault(const Body& body, std::int64_t step_number) const;
};

}  // namespace sim
