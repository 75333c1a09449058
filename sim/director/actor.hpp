// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/time.hpp"
#include "sim/script/actor_config.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class Stage;
struct WorldObject;

/// Actor in the world.  Its pose is a function of its last command and the time since then, without accumulation over
/// steps.
class Actor {
 public:
  explicit Actor(const ActorConfig& config);
  const ActorConfig& config() const { return config_; }
  void command(ActorCommand command, Time now);
  Pose pose_at(Time now) const;
  /// Places its object at the start of the path.
  void place(Stage& stage);
  /// Moves its object so that it reaches its pose at the end of the step that starts now.
  void step(Stage& stage, Time now);
  void visit_state(StateArchive& archive) { archive(since_, from_, direction_, moving_, X_WV_); }

 private:
  void find_object(Stage& stage);
  double progress_at(Time now) const;
  void anchor(Time now);

  const ActorConfig& config_;
  Path path_;
  double rate_;      ///< of the path parameter, per second
  Time since_{0};    ///< time of the last command
  double from_ = 0;  ///< progress at the last command; reverse: up to twice the length, forward and back
  int direction_ = 1;
  bool moving_ = true;
  // Looked up by name again after entities were added or removed.
  const WorldObject* object_ = nullptr;
  Pose X_WV_ = Pose::Identity();  ///< last commanded pose of the object
  std::uint64_t generation_ = ~std::uint64_t{0};
};

}  // namespace sim
