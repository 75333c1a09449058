// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/actor.hpp"

#include <algorithm>
#include <cmath>

#include "sim/director/stage.hpp"
#include "sim/vehicle/entities.hpp"

namespace sim {

Actor::Actor(const ActorConfig& config)
    : config_(config),
      path_(config.make_path()),
      rate_(config.path == PathKind::timed ? 1.0 : config.speed_mps),
      since_(from_seconds(config.start_s)),
      moving_(config.starts == ActorStart::moving) {}

double Actor::progress_at(Time now) const {
  const double length = path_.length();
  if (!moving_ || now <= since_) return from_;
  const double progress = from_ + direction_ * rate_ * to_seconds(now - since_);
  if (config_.ends == PathEnds::stop) return std::clamp(progress, 0.0, length);
  const double period = config_.ends == PathEnds::reverse ? 2 * length : length;
  return progress - period * std::floor(progress / period);
}

Pose Actor::pose_at(Time now) const {
  const double progress = progress_at(now);
  return path_.pose_at(progress > path_.length() ? 2 * path_.length() - progress : progress);
}

void Actor::anchor(Time now) {
  from_ = progress_at(now);
  since_ = std::max(since_, now);
}

void Actor::command(ActorCommand command, Time now) {
  anchor(now);
  moving_ = command != ActorCommand::stop;
  if (command == ActorCommand::start || command == ActorCommand::stop) return;
  // On the return path only the position counts, not the number of passes.
  if (from_ > path_.length()) from_ = 2 * path_.length() - from_;
  direction_ = command == ActorCommand::forward ? 1 : -1;
}

void Actor::find_object(Stage& stage) {
  if (generation_ == stage.entities().generation()) return;
  const WorldObject* object = stage.entities().find_object(config_.object);
  // Only a kinematic body can be moved along a path; the world makes the first one of an actor's object kinematic.
  object_ = object && object->base().kinematic() ? object : nullptr;
  generation_ = stage.entities().generation();
}

void Actor::place(Stage& stage) {
  find_object(stage);
  X_WV_ = pose_at(Time{0});
  if (object_ != nullptr) object_->place(stage.physics(), X_WV_);
}

void Actor::step(Stage& stage, Time now) {
  find_object(stage);
  if (object_ == nullptr) return;  // removed; placed again when it is added again
  // The object was moved, or is new: place it without velocity, because the displacement in one step would be a very
  // fast impact on others.
  const Pose X_WV = object_->X_WV();
  constexpr double turned = 0.02;  // 0.8 degrees, far more than what a step of the integration errs
  if ((X_WV.translation() - X_WV_.translation()).squaredNorm() > 1e-12 ||
      (X_WV.linear() - X_WV_.linear()).norm() > turned)
    object_->place(stage.physics(), pose_at(now));
  const Time step = stage.clock().step;
  X_WV_ = pose_at(now + step);
  object_->base().move_to(object_->base_pose(X_WV_), to_seconds(step));
}

}  // namespace sim
