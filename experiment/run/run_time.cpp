// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_error.hpp"
#include "experiment/run/run.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "shoal/message_codec.hpp"
#include "sim/base/log.hpp"

// Actions of a run when its world moves in time, and when it writes snapshots.

namespace experiment {

void Run::leave_branch(std::int64_t to_step, bool ours) {
  parts_.journal.finish();
  branch_log_.prepare(parts_.control.branch + 1, to_step, ours);
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

void Run::publish_snapshot() {
  if (!parts_.buses.has_listeners()) return;
  sim::Bytes buffer;
  for (const shoal::sim_snapshot_t& piece :
       in_pieces(time_.snapshot(), parts_.control.branch, parts_.journal.sequence())) {
    shoal::encode_into(piece, buffer);
    parts_.buses.outer().publish("sim.snapshot", buffer, parts_.world.now());
  }
}

void Run::start_branch(bool ours) {
  branch_log_.branch(parts_.control.branch);
  view_.set_branch(parts_.control.branch);
  view_.discard();
  if (page_) page_->moved(parts_.world, parts_.control, ours, {});
  parts_.lockstep.set_branch(parts_.control.branch);
  parts_.buses.set_time(parts_.world.now());
  parts_.service.report_changes();
  parts_.service.publish_info();
  if (!ours) {  // this step was not observed
    publish_snapshot();
    parts_.service.publish_step();
    parts_.journal.after_step();
  }
  parts_.buses.end_of_step();
  branch_log_.mark(parts_.world.step_number(), time_.oldest_step().value_or(parts_.world.step_number()));
  progress_.restart(parts_.world.now());
  if (results_) results_->start_branch(parts_.world.now(), ours);
}

/// An existing file ends the run now, not when its snapshot is due.
void Run::check_planned_snapshots() const {
  try {
    for (const std::int64_t step : snapshot_plan_.next_steps()) time_.check_planned_snapshot(step);
  } catch (const std::exception& error) {
    throw RunError(4, "bus", error.what());
  }
}

void Run::report_missed_snapshots() const {
  for (const double time_s : snapshot_plan_.missing_s())
    sim::log_warn("--snapshot-at: no snapshot of {:.6g} s was written: the run ended before it", time_s);
}

void Run::take_snapshots() {
  if (!snapshot_plan_.take(parts_.world.step_number())) return;
  try {
    progress_.clear();
    sim::log_info("{}", time_.write_planned_snapshot());
  } catch (const std::exception& error) {  // requested on the command line: a failure must be reported
    throw RunError(4, "bus", error.what());
  }
}

}  // namespace experiment
