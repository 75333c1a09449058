// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/time.hpp"
#include "sim/script/actor_config.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class Body;
class Stage;

/// An actor in the world.  Where it is follows from its last command and the time since, with no sum over steps.
class Actor {
 public:
  explicit Actor(const ActorConfig& config);
  const ActorConfig& config() const { return config_; }
  void command(ActorCommand command, Time now);
  Pose pose_at(Time now) const;
  /// Puts its object at the beginning of the path.
  void place(Stage& stage);
  /// Moves its object so that it is in its place at the end of the step that begins now.
  void step(Stage& stage, Time now);
  void visit_state(StateArchive& archive) { archive(since_, from_, direction_, moving_, X_WB_); }

 private:
  void find_body(Stage& stage);
  double progress_at(Time now) const;
  void anchor(Time now);

  const ActorConfig& config_;
  Path path_;
  double rate_;      ///< of the path's parameter, per second
  Time since_{0};    ///< when the last command came
  double from_ = 0;  ///< progress then; bounce: up to twice the length, there and back
  int direction_ = 1;
  bool moving_ = true;
  // The object by its name, looked up again when entities were added or removed.
  Body* body_ = nullptr;
  Pose X_WB_ = Pose::Identity();  ///< where it was sent last
  std::uint64_t generation_ = ~std::uint64_t{0};
};

}  // namespace sim
