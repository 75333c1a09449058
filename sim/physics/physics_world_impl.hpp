// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/free_numbers.hpp"
#include "sim/ode/body_copy.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/ode/part_shape.hpp"
#include "sim/physics/collider.hpp"
#include "sim/physics/islands.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/physics/terrain_geom.hpp"
#include "sim/rays/world_scene.hpp"

namespace sim {

// Members are destroyed from the last to the first: joints and bodies before their world.
struct PhysicsWorld::Impl {
  /// Bodies, parts and joints of a group, by number.
  struct Group {
    std::string name;
    bool in_use = false;
    std::vector<int> bodies, parts, joints;
  };

  Impl(const PhysicsConfig& config_, ContactTable table, std::uint64_t seed_)
      : config(config_), seed(seed_), collider(config_, std::move(table)) {}

  PhysicsConfig config;
  std::uint64_t seed;
  std::vector<std::string> categories = {"solid"};
  MeshCache meshes;
  std::map<int, std::unique_ptr<CollisionTerrain>> terrains;  // by part; outlive the geoms of collider and scene
  // ODE's default threading is shared by all worlds of the process, and two worlds in two threads would abort.
  ThreadingHandle threading{dThreadingAllocateSelfThreadedImplementation()};
  WorldHandle world{dWorldCreate()};
  JointGroupHandle contacts{dJointGroupCreate(0)};
  Collider collider;
  Islands islands;
  std::vector<Group> groups;
  std::vector<PartInfo> parts;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Joint>> joints;
  FreeNumbers group_numbers, part_numbers, body_numbers, joint_numbers;
  // Lists for the loops of a step, in order of groups.
  std::vector<Body*> moving;                             // free and kinematic
  std::vector<std::pair<int, Joint*>> joints_with_axes;  // with their groups
  std::vector<Body*> kinematic;
  std::vector<Joint*> measured_joints;
  std::vector<ContactReport> contact_reports;
  double gravity_mps2 = config.gravity_mps2;
  bool gravity_was_set = false;  ///< set_gravity() was called
  SceneMoves moves;
  std::unique_ptr<WorldScene> scene;
  std::vector<Body*> lone_;             // bodies without contacts and joints in this step
  std::vector<BodyCopy> before_step_;   // of the bodies that the exact solver steps
  std::vector<dBodyID> large_, small_;  // bodies by the rows of their islands; buffers reused in each step
  StepCounts counts;
  std::int64_t quick_steps = 0;
  bool broken = false;  ///< ODE threw an error within a step

  std::uint32_t category_bit(const std::string& name) const;
  std::uint32_t category_bits(const std::vector<std::string>& names) const;
  Group& group(int number);
  void attach_ode_body(Body& body);
  void add_parts(Body& body, const BodyConfig& config);
  /// Checked part that is not yet in the world.
  struct NewPart {
    GeomHandle geom;
    const CollisionMesh* mesh = nullptr;
    std::unique_ptr<CollisionTerrain> terrain;
  };
  NewPart make_part(const Body& body, const PartConfig& part, const std::string& who);
  void add_part(Body& body, const BodyConfig& config, std::size_t index, NewPart made);
  void remove_from_lists(int group_number);
  void set_mass(Body& body, const BodyConfig& config, const dMass& total);
  void collide();
  void solve(std::int64_t step_number);
  bool step_lone_bodies();
  void step_islands_by_size(std::int64_t step_number);
  void step_exactly(std::int64_t step_number);
  std::string suspects();
  void finish(std::int64_t step_number);
  bool out_of_bounds(const Body& body) const;
  [[noreturn]] void fault(const Body& body, std::int64_t step_number) const;
};

}  // namespace sim
