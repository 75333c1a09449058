#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/math.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/joint.hpp"
#include "sim/physics/physics_config.hpp"
#include "sim/scene/scene.hpp"
#include "sim/state_hash.hpp"

namespace sim {

/// A body became NaN or flew off, or ODE gave up.  The world cannot be stepped any further.
class PhysicsFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One part as built: who it belongs to.
struct PartInfo {
  std::string name;
  int group = -1;
  int body = -1;  ///< number in PhysicsWorld::bodies()
  int material = 0;
  std::uint32_t category = 1;
};

/// Work done by the last step, the same in every run.
struct StepCounts {
  int contacts = 0;
  int largest_island_rows = 0;
  bool quick = false;  ///< QuickStep was used
};

/// Rigid bodies, joints and contacts, stepped by ODE.  Knows no vehicle and no device: a vehicle or an object is a
/// group, whose parts share one collision space.
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
  /// object.  A fixed body has no mass and never moves.  Throws ConfigError (mesh files; no mass).
  Body& add_body(int group, const BodyConfig& config, const Pose& X_WV, bool fixed = false);
  /// `second` null: the world.  At the pose the bodies have now, which is the joint's zero.
  Joint& add_joint(int group, const JointConfig& config, Body& first, Body* second, const Pose& X_WV);
  /// Ends a group: puts its parts into the world's space.  Call after its last body.
  void close_group(int group);

  /// One step of `config.step_s`: collide, solve, check.  Throws PhysicsFault naming the body.
  void step(std::int64_t step_number);

  const Scene& scene() const;
  std::span<const std::unique_ptr<Body>> bodies() const;
  std::span<const std::unique_ptr<Joint>> joints() const;
  std::span<const PartInfo> parts() const;
  const std::string& group_name(int group) const;
  const StepCounts& last_step() const;
  /// Steps in which QuickStep stood in for WorldStep because an island was too large.
  std::int64_t quick_steps() const;
  /// Bit of a category name.  Throws std::out_of_range.
  std::uint32_t category_bit(const std::string& name) const;
  double step_s() const;
  /// Bodies in order: position, rotation, velocities; joints: motor targets.
  void hash_state(StateHash& hash) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
