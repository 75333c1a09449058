// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "bridges/control/sim_service.hpp"
#include "experiment/run/run_inputs.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/snapshot/snapshot_file.hpp"
#include "experiment/time/world_time.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Interface to rewind and restore a run.
class Timeline {
 public:
  virtual ~Timeline() = default;
  /// Prepares a move; the branch is still the old one.  `ours`: the new one starts at a step of this run.  The world is
  /// not moved when this throws.
  virtual void leave_branch(std::int64_t to_step, bool ours) = 0;
  /// Replaces start_branch() when the move failed and the world was restored.
  virtual void hold_here() = 0;
  /// Completes a move.
  virtual void start_branch(bool ours) = 0;
};

/// Time control of a running world: a WorldTime, and the inputs since its oldest state, with which the run is taken to
/// any step since then; and snapshot files.
///
/// A rewind starts a new branch: RunControl::branch is incremented.
class TimeControl final : public bridges::TimeMachine {
 public:
  struct Options {
    double rewind_s = 0;  ///< longest rewind; 0: no rewind
    std::size_t max_bytes = std::size_t{64} << 20;
    std::string directory;       ///< of snapshot files; empty: requests for snapshots are rejected
    bool overwrite = false;      ///< snapshot files may replace others
    std::string resolved_world;  ///< YAML
    std::string files;           ///< files_text() of the world
    std::string version;         ///< of shoal
    double scores_from_s = 0;    ///< start of the scores
  };
  /// All must outlive this.
  TimeControl(sim::World& world, sim::RunControl& control, Scoring& scoring, bridges::SimService& service,
              RunInputs& inputs, Options options, Timeline& timeline);

  /// To be called before the first step, and after each.
  void after_step();
  bool stop_when_there() { return time_.stop_when_there(); }

  /// Executes all requests about time: pause, resume, step, speed, until, rewind, snapshot, restore and where.  Throws
  /// std::runtime_error with the reason of a rejection.
  std::optional<std::string> execute(const std::string& command, const std::string& text, double value) override;
  /// Rewinds by a number of seconds, at most to the start of this run.
  std::string rewind(double seconds, bool run_on);
  /// Writes a file into the directory of snapshots; an empty name is replaced by one with the step.  Clients can
  /// request up to 1000 files.
  std::string write_snapshot(const std::string& name);
  /// Writes a snapshot that the command line requested, without a limit.
  std::string write_planned_snapshot();
  /// Throws std::runtime_error when the file of a planned snapshot exists already, and may not be replaced.
  void check_planned_snapshot(std::int64_t step) const;
  /// Continues from a file in the directory of snapshots.  With lockstep clients it rewinds to that step as rewind()
  /// does, so that they are restored too; this is limited to files that this run wrote, and to its history.
  std::string restore(const std::string& name, bool run_on);

  /// Starts a run from a snapshot.  Throws std::runtime_error when it does not match.
  void go_on_from(const Snapshot& snapshot);
  double scores_from_s() const { return options_.scores_from_s; }
  /// Returns a snapshot of the present state.
  Snapshot snapshot() const;
  /// Returns the present position in time: `step 2000, 20.00 s, branch 1`.
  std::string place() const;
  /// Returns true once after each move in time.
  bool has_moved() const { return moved_; }
  bool take_moved() { return std::exchange(moved_, false); }
  /// Returns why the world cannot continue.
  const std::string& broken() const { return broken_; }
  std::size_t bytes() const { return time_.bytes() + inputs_.bytes(); }
  std::optional<std::int64_t> oldest_step() const { return time_.oldest_kept(); }

 private:
  void discard_all();
  void simulate_again(std::int64_t to_step);
  /// Executes `work`, which moves the world in time; restores the world when that fails.
  void travel(const std::function<void()>& work, std::int64_t to_step, bool run_on, bool ours);
  void restore_saved(const SavedRun& before);
  /// Moves to a step of this branch, from an earlier snapshot in memory.
  void rewind_to(std::int64_t base, std::int64_t target, bool run_on);
  void restore_with_clients(const Snapshot& snapshot, const std::string& path, bool run_on);
  std::string what_is_kept() const;
  std::string planned_name(std::int64_t step) const;
  std::string write_file(const std::string& name);
  std::string path_of(const std::string& name) const;

  sim::World& world_;
  sim::RunControl& control_;
  Scoring& scoring_;
  bridges::SimService& service_;
  RunInputs& inputs_;
  Options options_;
  Timeline& timeline_;
  WorldTime time_;
  std::int64_t first_step_ = 0;  ///< first step of this run, or of an earlier file
  int files_ = 0;
  /// Steps at which a file was written, with the hash of its state: of this branch, as far back as its history is
  /// known.
  std::map<std::int64_t, std::uint64_t> written_;
  bool moved_ = false;
  std::string broken_;
};

}  // namespace experiment
