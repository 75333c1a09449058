// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "bridges/view/view_publisher.hpp"
#include "experiment/results/results.hpp"
#include "experiment/run/branch_log.hpp"
#include "experiment/run/run_inputs.hpp"
#include "experiment/run/run_key_file.hpp"
#include "experiment/run/run_keys.hpp"
#include "experiment/run/run_parts.hpp"
#include "experiment/run/run_programs.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/step_watch.hpp"
#include "experiment/run/time_control.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/terminal/progress.hpp"
#include "experiment/time/pacer.hpp"
#include "experiment/time/snapshot_plan.hpp"
#include "sim/base/shared_work.hpp"

namespace experiment {

/// One run of a world: its components and the step loop.
///
/// RunParts are the world, its buses and what programs get from them.  Around them are those that watch the world
/// (scores, ViewPublisher, page, results), those that move it in time (TimeControl, with RunInputs and BranchLog), and
/// those that end the run (programs, StepWatch, signals).  The constructor makes all of them; go() runs the loop:
///
///   execute       requests of clients, pages and keys; while the run is paused only these
///   pace          waits for the wall clock, executing requests
///   admit         inputs from outside enter the world, the journal and the page
///   World::step
///   end_of_step   all that watch, in this order: messages of the service, scores, messages for viewers, the journal
///                 (it ends the step in a record), the page, results; then the buses send, and a state is kept
///   synchronize   ticks to the lockstep clients; waits for their answers, executing requests
///
/// A request may move the world in time while it is executed.  TimeControl then calls leave_branch() before the move
/// and start_branch() after it (hold_here() if it failed), and the loop continues in the new branch, at synchronize().
/// Whatever ends the run early is thrown (RunError, PhysicsFault, LockstepTimeout), and becomes the exit code in go();
/// finish() then says goodbye to the clients, stops the programs and writes the results in any case.
class Run final : private Timeline {
 public:
  /// Both must outlive this.  Throws ConfigError, BusError, std::runtime_error.
  Run(const sim::LoadedWorld& loaded, const RunOptions& options);
  /// Runs from the first step to the summary.
  Summary go();

 private:
  /// Creates the key of the run when control requires one; otherwise returns null.
  std::unique_ptr<RunKeyFile> make_key();
  void start_clients();
  void await(const std::vector<std::string>& clients);
  void loop();
  void step();
  /// Delivers the inputs from outside to the world, and records them.
  void admit_messages();
  void end_of_step();
  TimeControl::Options time_options() const;
  void leave_branch(std::int64_t to_step, bool ours) override;
  void hold_here() override;
  void start_branch(bool ours) override;
  RunParts::Options parts_options();
  TapBus::Listener page_tap();
  /// Returns the way of commands of pages that drive: as messages from outside.
  RunPage::Publish drive_publisher();
  /// Carries out the requests of the pages.
  void serve_page();
  /// Publishes the state from which the run continues, so that a log that starts here can be replayed.
  void publish_snapshot();
  void check_planned_snapshots() const;
  void take_snapshots();
  void report_missed_snapshots() const;
  /// Executes requests and keys.
  void execute();
  void synchronize();
  /// Waits until the next step is due, and answers requests in the meantime.
  void pace();
  void check_bus() const;
  /// Reports very slow steps.  Throws RunError for a step beyond the limit of the world.
  void check_step_time();
  void check_programs();
  /// Returns whether a signal, or the caller, ends the run.
  bool must_end() const;
  bool may_continue() const;
  std::string how_ended() const;
  std::uint64_t messages() const;
  void finish(Summary& summary);
  /// Warns of what was silent, and keeps the lines.
  void warn_at_end(Summary& summary);
  void add_figures(Summary& summary);
  void write_results(Summary& summary);

  const sim::LoadedWorld& loaded_;
  const RunOptions& options_;
  std::unique_ptr<RunPage> page_;  ///< live page; null: none.  Outlives the buses, which it taps.
  const std::string files_;        ///< hashes of the files that the world names
  RunParts parts_;
  Scoring scoring_;
  bridges::ViewPublisher view_;
  RunInputs inputs_;
  BranchLog branch_log_;
  TimeControl time_;
  double duration_s_;
  SnapshotPlan snapshot_plan_;
  Progress progress_;
  Pacer pacer_;
  std::unique_ptr<RunKeyFile> key_file_;  ///< null: control needs no key
  RunPrograms programs_;
  StepWatch watch_{parts_.world};
  sim::SharedWork shared_work_;
  bool synchronized_ = true;  ///< the clients have answered the present step
  bool alone_ = true;         ///< no other simulator was found at the start
  std::unique_ptr<Results> results_;
  std::unique_ptr<RunKeys> keys_;  ///< null: no terminal
  std::int64_t steps_taken_ = 0;   ///< in this process
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace experiment
