// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/thread_pool.hpp"
#include "sim/physics/far_groups.hpp"
#include "sim/physics/shards.hpp"

namespace sim {

/// The step of groups that are one body without joints, as most marine vehicles are: while such a body touches nothing
/// it does not go through ODE.  This class owns
/// - the list of these bodies, with their shards,
/// - the list of those of them that are in the collision space, near something,
/// - whether the parts of single bodies are behind them.
///
/// A body that is stepped here gets its motion written into ODE's memory, bit by bit as ODE does, but its parts are not
/// marked as moved, which would cost as much as the step.  They follow when something looks at them (bring_parts(), the
/// scene calls it by SceneMoves), or before the search for pairs if the body is near something.
///
/// Order within a step: list_again(); mark_near(), after FarGroups::update() and before the search for pairs; when
/// Shards has placed the groups list_again(); step(), which leaves bodies with pairs, and those that take steps of
/// first order, to Shards.
///
/// Threads share step(): each body changes only itself and its shard.  Nothing here is hashed or saved.
class SingleBodies {
 public:
  SingleBodies(const StepSettings& settings, const Groups& groups, Shards& shards, const FarGroups& far_groups,
               const MovedBodies& moved)
      : settings_(settings), groups_(groups), shards_(shards), far_groups_(far_groups), moved_(moved) {}

  /// Lists the bodies, if what shards hold has changed.
  void list_again() {
    if (!shards_.listed()) list();
  }
  /// Marks the parts of those in the collision space as moved.
  void mark_near();
  /// Steps those without pairs.  Returns whether a body is out of bounds.
  bool step(ThreadPool* threads);
  /// Lets the parts of all single bodies follow them, before anything outside of the step looks at parts.
  void bring_parts();

 private:
  struct Single {
    SteppedBody* body;
    int shard;
  };
  void list();
  void step_alone(SteppedBody& body) const;

  const StepSettings& settings_;
  const Groups& groups_;
  Shards& shards_;
  const FarGroups& far_groups_;
  const MovedBodies& moved_;
  std::vector<Single> singles_;
  std::vector<SteppedBody*> near_;  // with parts, in the collision space
  bool near_known_ = false;
  std::uint64_t near_changes_ = 0;  // of far_groups_, when near_ was listed
  bool parts_behind_ = false;       // parts are not marked as moved
};

}  // namespace sim
