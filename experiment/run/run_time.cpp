// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "experiment/results/run_error.hpp"
#include "experiment/run/run.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "shoal/message_codec.hpp"
#include "sim/base/log.hpp"

// Actions of a run when its world moves in time, and when it writes snapshots.

namespace experiment {

void Run::leave_branch(std::int64_t to_step, bool ours) {
  journal_.finish();
  branch_log_.prepare(control_.branch + 1, to_step, ours);
  if (!results_) return;
  Summary left;
  left.ended = "rewound";
  left.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  add_figures(left);
  results_->keep_branch(left, scoring_, loaded_.resolved);
}

void Run::hold_here() {
  branch_log_.give_up();
  if (results_) results_->drop_branch();
}

bool Run::has_listeners() {
  return buses_.over_lcm() || !options_.record.empty() || page_ != nullptr;
}

void Run::publish_snapshot() {
  if (!has_listeners()) return;
  sim::Bytes buffer;
  for (const shoal::sim_snapshot_t& piece : in_pieces(time_.snapshot(), control_.branch, journal_.sequence())) {
    shoal::encode_into(piece, buffer);
    buses_.outer().publish("sim.snapshot", buffer, world_.now());
  }
}

void Run::start_branch(bool ours) {
  branch_log_.branch(control_.branch);
  view_.set_branch(control_.branch);
  view_.discard();
  if (page_) page_->moved(world_, control_, ours, {});
  lockstep_.set_branch(control_.branch);
  buses_.set_time(world_.now());
  service_.report_changes();
  service_.publish_info();
  if (!ours) {  // this step was not observed
    publish_snapshot();
    service_.publish_step();
    journal_.after_step();
  }
  buses_.end_of_step();
  branch_log_.mark(world_.step_number(), time_.oldest_step().value_or(world_.step_number()));
  progress_.restart(world_.now());
  if (results_) results_->start_branch(world_.now(), ours);
}

void Run::plan_snapshots() {
  const double step_s = sim::to_seconds(world_.step_time());
  for (const double time_s : options_.snapshot_at_s) {
    if (duration_s_ > 0 && std::llround(time_s / step_s) > std::llround(duration_s_ / step_s))
      throw RunError(
          2, "configuration",
          fmt::format("--snapshot-at: {:.6g} s is after the end of the run at {:.6g} s", time_s, duration_s_));
    if (std::llround(time_s / step_s) < world_.step_number())
      throw RunError(2, "configuration",
                     fmt::format("--snapshot-at: {:.6g} s is before the start of the run at {:.6g} s", time_s,
                                 sim::to_seconds(world_.now())));
    snapshot_steps_.insert(std::llround(time_s / step_s));
  }
  // An existing file ends the run now, not when its snapshot is due.
  std::set<std::int64_t> planned = snapshot_steps_;
  if (options_.snapshot_every_s) {
    const double per_step = step_s / *options_.snapshot_every_s;
    const double next = std::floor((2 * static_cast<double>(world_.step_number()) + 1) * per_step / 2) + 1;
    planned.insert(static_cast<std::int64_t>(std::ceil(next / per_step - 0.5)));
  }
  try {
    for (const std::int64_t step : planned) time_.check_planned_snapshot(step);
  } catch (const std::exception& error) {
    throw RunError(4, "bus", error.what());
  }
}

void Run::report_missed_snapshots() const {
  for (const std::int64_t step : snapshot_steps_)
    sim::log_warn("--snapshot-at: no snapshot of {:.6g} s was written: the run ended before it",
                  sim::to_seconds(world_.step_time() * step));
}

void Run::take_snapshots() {
  const std::int64_t step = world_.step_number();
  bool due = snapshot_steps_.erase(step) > 0;
  if (options_.snapshot_every_s && steps_taken_ > 0) {
    const double per_step = sim::to_seconds(world_.step_time()) / *options_.snapshot_every_s;
    const auto half_steps = static_cast<double>(2 * step);  // whole numbers: a time halfway between steps counts once
    due = due || std::floor((half_steps + 1) * per_step / 2) > std::floor((half_steps - 1) * per_step / 2);
  }
  if (!due) return;
  try {
    progress_.clear();
    sim::log_info("{}", time_.write_planned_snapshot());
  } catch (const std::exception& error) {  // requested on the command line: a failure must be reported
    throw RunError(4, "bus", error.what());
  }
}

}  // namespace experiment
