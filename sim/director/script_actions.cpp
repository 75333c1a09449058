// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include <algorithm>
#include <numeric>

#include "sim/bus/utime_stamp.hpp"
#include "sim/config/message_text.hpp"
#include "sim/director/script.hpp"
#include "sim/director/stage.hpp"
#include "sim/vehicle/end_of_run.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/world_error.hpp"
#include "sim/vehicle/world_warnings.hpp"

// What the actions of events do.

namespace sim {

void Script::carry_out(const std::vector<Action>& actions, const Doing& doing) {
  for (const Action& action : actions) {
    std::string failure;
    try {
      carry_out(action, doing);
    } catch (const ConfigError& error) {
      failure = error.lines().front();
    } catch (const std::exception& error) {  // one action that fails does not end the run
      failure = error.what();
    }
    if (failure.empty()) continue;
    if (doing.diagnostics != nullptr)
      doing.diagnostics->error(action.place, action.who, failure);
    else
      stage_.warnings().bad_message(doing.who, failure);
  }
}

void Script::carry_out(const Action& action, const Doing& doing) {
  switch (action.kind) {
    case ActionKind::move:
      return move(action, doing);
    case ActionKind::add:
      return add(action, doing);
    case ActionKind::remove:
      return remove(action, doing);
    case ActionKind::one_of:
      return carry_out(*pick_choice(action, doing), doing);
    case ActionKind::fault:
      return stage_.set_fault(action.targets[0], action.fault);
    case ActionKind::clear_fault:
      return stage_.clear_faults(action.targets[0]);
    case ActionKind::set:
      return change(action, doing);
    case ActionKind::publish:
      return publish(action);
    case ActionKind::actor:
      return command(action);
    case ActionKind::trigger:
      for (std::size_t i = 0; i < events_.size(); ++i)
        if (events_[i].config.name == action.targets[0]) attempt(i, doing.depth + 1);
      return;
    case ActionKind::gravity:
      return stage_.set_gravity(action.gravity_mps2);
    case ActionKind::log:
      return log(doing.who, action.text);
    case ActionKind::end:
      return stage_.end({printable(action.text), action.passed});
  }
}

const std::string& Script::pick_target(const Action& action, const Doing& doing) const {
  if (action.targets.size() == 1) return action.targets[0];
  return action.targets[doing.random.integer_below(static_cast<std::uint32_t>(action.targets.size()))];
}

const std::vector<Action>* Script::pick_choice(const Action& action, const Doing& doing) const {
  if (action.weights.empty())
    return &action.choices[doing.random.integer_below(static_cast<std::uint32_t>(action.choices.size()))];
  double left = doing.random.uniform() * std::accumulate(action.weights.begin(), action.weights.end(), 0.0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < action.weights.size(); ++i) {
    if (action.weights[i] <= 0) continue;
    last = i;
    left -= action.weights[i];
    if (left < 0) break;
  }
  return &action.choices[last];
}

void Script::move(const Action& action, const Doing& doing) {
  const std::string& name = pick_target(action, doing);
  if (const Vehicle* vehicle = stage_.entities().find_vehicle(name))
    return stage_.move_vehicle(name, action.where.choose(vehicle->X_WV(), doing.random));
  const WorldObject* object = stage_.entities().find_object(name);
  if (object == nullptr) throw WorldError("there is no vehicle or object '" + name + "' to move");
  stage_.move_object(name, action.where.choose(object->body->X_WB(), doing.random));
}

void Script::make_catalogue() {
  if (catalogued_) return;
  catalogued_ = true;
  for (const ObjectConfig& object : stage_.config().objects) {
    const Pose X_WE = make_pose(object.position_m, object.rpy_rad);
    if (object.count == 1) {
      catalogue_[object.name] = {&object, X_WE};
      continue;
    }
    const std::vector<Pose> poses = place_instances(object.placement, object.count, X_WE,
                                                    static_cast<std::uint64_t>(stage_.config().run.seed), object.name);
    for (std::size_t i = 0; i < poses.size(); ++i)
      catalogue_[object.name + std::to_string(i + 1)] = {&object, poses[i]};
  }
}

void Script::add(const Action& action, const Doing& doing) {
  const std::string& name = action.targets[0];
  if (action.object) {
    const Pose X_WE = make_pose(action.object->position_m, action.object->rpy_rad);
    stage_.add_object(*action.object, name, action.where.choose(X_WE, doing.random));
    return;
  }
  make_catalogue();
  const auto found = catalogue_.find(name);
  if (found == catalogue_.end()) throw WorldError("the world file has no object '" + name + "' to add");
  stage_.add_object(*found->second.first, name, action.where.choose(found->second.second, doing.random));
}

void Script::remove(const Action& action, const Doing& doing) {
  const std::string& name = pick_target(action, doing);
  if (stage_.entities().find_vehicle(name) != nullptr) return stage_.remove_vehicle(name);
  if (stage_.entities().find_object(name) == nullptr)
    throw WorldError("there is no vehicle or object '" + name + "' to remove");
  stage_.remove_object(name);
}

void Script::change(const Action& action, const Doing&) {
  Diagnostics diagnostics;
  stage_.change_device(action.targets[0], action.values, diagnostics);
  diagnostics.throw_if_any();
}

void Script::log(const std::string& who, const std::string& text) {
  constexpr int most_lines = 1000;
  if (++log_lines_ > most_lines + 1) return;
  if (log_lines_ > most_lines)
    spdlog::warn("events have said {} lines; what they say from now on is left out", most_lines);
  else
    spdlog::info("{}{}{} (at {:.3f} s)", who, who.empty() ? "" : ": ", printable(text), to_seconds(stage_.now()));
}

void Script::publish(const Action& action) {
  Bytes payload = action.payload;
  if (action.stamp_utime) set_utime(payload, stage_.config().epoch_us + stage_.now().count());
  stage_.publish(action.channel, payload);
}

void Script::command(const Action& action) {
  for (Actor& actor : actors_)
    if (actor.config().name == action.targets[0]) actor.command(action.command, stage_.now());
}

}  // namespace sim
