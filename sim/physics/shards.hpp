// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "sim/base/thread_pool.hpp"
#include "sim/physics/shard_solver.hpp"

namespace sim {

/// The ODE worlds, and which groups share one: those whose boxes overlap, in the world of the one with the lowest
/// number. This class owns
/// - the shards, and which shard each part belongs to,
/// - lists of what they hold: of the single ones, which are one body without joints, and of the others,
/// - which shards ODE steps in this step,
/// - the solvers that threads use.
///
/// Order within a step:
/// 1. list(), if a group was added, removed or moved to another shard (SingleBodies calls it, since it has pointers),
/// 2. bring_together(): groups of which parts may touch come into one shard.  Their bodies and joints are created again
///    in its world, in the order of their numbers, to the last bit.  Groups that are no longer near each other are
///    separated from time to time; it makes no difference to their motion,
/// 3. give_pairs(): each shard gets its pairs, and those with pairs will be stepped by ODE,
/// 4. SingleBodies steps the single ones that have none, and calls step_by_ode() for those that need ODE all the same,
/// 5. step(): all that are left, shared among threads.  What they leave is in stepped(), in the order of their numbers.
///
/// Threads change only the shards that they step.  Where a group is is neither hashed nor saved.
///
/// A solver of a step that failed is kept, but not used again: ODE may have left it in any state.
class Shards {
 public:
  /// Of these, only `moved` is notified of what a step did.
  Shards(const StepSettings& settings, Groups& groups, Collider& collider, Islands& islands, const MovedBodies& moved)
      : settings_(settings), groups_(groups), collider_(collider), islands_(islands), moved_(moved) {}

  // Between steps.
  /// The ODE world of a group, which is made when the group gets its first moving body.
  dWorldID world_of(int group);
  /// Notes a new part of a group; `fixed`: its body does not move.
  void add_part(int part, int group, bool fixed);
  /// Notes that a group has a new body or joint.
  void note_change(int group);
  /// Removes a group that is about to be destroyed, and moves the others out of its shard.
  void leave(int group);
  /// Destroys the ODE world of a group that was destroyed, if no other group is in it.
  void destroy_if_empty(int shard);
  /// Gives all worlds the gravity of the settings.
  void set_gravity();

  // Of a step.
  bool listed() const { return listed_; }
  void list();
  /// Numbers of the shards that are one body without joints.
  const std::vector<int>& singles() const { return singles_; }
  const Shard& operator[](int number) const { return *shards_[static_cast<std::size_t>(number)]; }
  void bring_together(const std::vector<Collider::Pair>& pairs, std::int64_t step_number);
  void give_pairs(const std::vector<Collider::Pair>& pairs);
  bool steps_by_ode(int shard) const { return steps_by_ode_[static_cast<std::size_t>(shard)] != 0; }
  /// Lets ODE step a shard.  Threads may do so for different shards.
  void step_by_ode(int shard);
  /// Steps the shards that are not single, and those of step_by_ode().  `threads` null: one thread.  Returns whether a
  /// body is out of bounds.
  bool step(ThreadPool* threads, std::int64_t step_number);
  /// Those of the last step.
  std::span<const Shard* const> stepped() const { return stepped_; }

 private:
  Shard& shard(int number);
  void list_content(Shard& shard) const;
  bool some_are_shared() const;
  void place_groups(const std::vector<Collider::Pair>& pairs, bool separate);
  void fill(int number, const std::vector<int>& desired);
  void move(int group, int to);
  void step_some(std::size_t begin, std::size_t end, std::int64_t step_number);
  std::unique_ptr<ShardSolver> take_solver();

  const StepSettings& settings_;
  Groups& groups_;
  Collider& collider_;
  Islands& islands_;
  const MovedBodies& moved_;
  std::vector<std::unique_ptr<ShardSolver>> solvers_, spoiled_solvers_;  // not used now; of steps that failed
  std::mutex solvers_mutex_;
  std::vector<std::unique_ptr<Shard>> shards_;  // by the group with the lowest number in it
  std::vector<int> shard_of_part_;              // -1: on a fixed body
  bool listed_ = false;
  std::vector<int> singles_, others_;  // by number
  std::vector<char> steps_by_ode_;     // by shard: whether it has pairs, or steps by ODE for another reason
  std::vector<Shard*> stepped_;        // by ODE in this step
};

}  // namespace sim
