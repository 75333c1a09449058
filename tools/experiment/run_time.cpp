#include <spdlog/spdlog.h>

#include <cmath>

#include "shoal/message_codec.hpp"
#include "tools/experiment/run.hpp"
#include "tools/experiment/run_error.hpp"
#include "tools/experiment/snapshot_pieces.hpp"

// What a run does beside when its world moves in time, and when it writes snapshots.

namespace tools {

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

void Run::stay() {
  branch_log_.give_up();
  if (results_) results_->drop_branch();
}

bool Run::heard() {
  return buses_.over_lcm() || !options_.record.empty();
}

void Run::publish_snapshot() {
  if (!heard()) return;
  sim::Bytes buffer;
  for (const shoal::sim_snapshot_t& piece : in_pieces(time_.snapshot(), control_.branch, journal_.sequence())) {
    shoal::encode_into(piece, buffer);
    buses_.outer().publish("sim.snapshot", buffer, world_.now());
  }
}

void Run::begin_branch(bool ours) {
  branch_log_.branch(control_.branch);
  lockstep_.set_branch(control_.branch);
  buses_.set_time(world_.now());
  service_.tell_changes();
  service_.publish_info();
  if (!ours) {  // nobody has seen this step
    publish_snapshot();
    service_.publish_step();
    journal_.after_step();
  }
  buses_.end_of_step();
  branch_log_.mark(world_.step_number(), time_.oldest_step().value_or(world_.step_number()));
  progress_.restart(world_.now());
  if (results_) results_->begin_branch(world_.now());
}

void Run::take_snapshots() {
  const double now_s = sim::to_seconds(world_.now());
  const double half_step_s = sim::to_seconds(world_.step_time()) / 2;
  bool due = false;
  while (!snapshot_at_s_.empty() && snapshot_at_s_.back() < now_s + half_step_s) {
    due = due || snapshot_at_s_.back() > now_s - half_step_s;
    snapshot_at_s_.pop_back();
  }
  if (options_.snapshot_every_s && steps_taken_ > 0) {
    const double since = std::floor((now_s + half_step_s) / *options_.snapshot_every_s);
    const double before = std::floor((now_s - half_step_s) / *options_.snapshot_every_s);
    due = due || since > before;
  }
  if (!due) return;
  try {
    progress_.clear();
    spdlog::info("{}", time_.write_planned_snapshot());
  } catch (const std::exception& error) {  // asked for on the command line: not to be missed
    throw RunError(4, "bus", error.what());
  }
}

}  // namespace tools
