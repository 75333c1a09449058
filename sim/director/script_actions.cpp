// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/director/stage.hpp"
#include "sim/director/world_observer.hpp"
#include "sim/vehicle/world_warnings.hpp"

// Functions of the script for the actions of events, which are in sim/actions.

namespace sim {

void Script::carry_out(const std::vector<ActionEntry>& actions, const ActionRun& run) {
  for (const ActionEntry& entry : actions) {
    std::string failure;
    try {
      entry.action->carry_out(run);
    } catch (const ConfigError& error) {
      failure = error.lines().front();
    } catch (const std::exception& error) {  // one action that fails does not end the run
      failure = error.what();
    }
    if (failure.empty()) continue;
    if (run.diagnostics != nullptr)
      run.diagnostics->error(entry.place, entry.who, failure);
    else
      stage_.warnings().bad_message(run.who, failure);
  }
}

void Script::trigger(const std::string& event, int depth) {
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (events_[i].config.name == event) attempt(i, depth);
}

void Script::command_actor(const std::string& actor, ActorCommand command) {
  for (Actor& each : actors_)
    if (each.config().name == actor) each.command(command, stage_.now());
}

void Script::make_catalog() {
  if (is_cataloged_) return;
  is_cataloged_ = true;
  for (const ObjectConfig& object : stage_.config().objects) {
    const Pose X_WE = make_pose(object.position_m, object.rpy_rad);
    if (object.count == 1) {
      catalog_[object.name] = {&object, X_WE};
      continue;
    }
    // The same draws as when the world is built, so that an object that appears later stands where it would have
    // stood.
    const std::vector<Pose> poses = place_instances(object.placement, object.count, X_WE,
                                                    static_cast<std::uint64_t>(stage_.config().run.seed), object.name);
    for (std::size_t i = 0; i < poses.size(); ++i) catalog_[object.name + std::to_string(i + 1)] = {&object, poses[i]};
  }
}

const Script::ListedObject* Script::find_listed(const std::string& name) {
  make_catalog();
  const auto found = catalog_.find(name);
  return found == catalog_.end() ? nullptr : &found->second;
}

void Script::log(const std::string& who, const std::string& text) {
  constexpr int max_lines = 1000;
  if (++log_lines_ > max_lines + 1) return;
  if (log_lines_ > max_lines)
    log_warn("events have logged {} lines; further lines are left out", max_lines);
  else
    log_info("{}{}{} (at {:.3f} s)", who, who.empty() ? "" : ": ", printable(text), to_seconds(stage_.now()));
  if (WorldObserver* const observer = stage_.observer(); observer != nullptr && log_lines_ <= max_lines)
    observer->happened({Occurrence::Kind::event, who, printable(text)});
}

}  // namespace sim
