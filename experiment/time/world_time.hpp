// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "bridges/control/sim_service.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/snapshot/snapshot_ring.hpp"
#include "sim/bus/bus.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// State of a run at one step: of its world, of its scores, and of the owners of its vehicles (SimService).
struct SavedRun {
  sim::Bytes state, scores, owners;
};

/// Returns the three as the sections of one archive, of which a SnapshotRing can take the difference part by part.
sim::Bytes joined(const SavedRun& saved);
/// Returns what joined() has joined.
SavedRun split(const sim::Bytes& bytes);

/// Time of a world that its users pause, step and take back: the requests about it, the step or event at which it
/// pauses, and its states of the last seconds.
///
/// A run (TimeControl) and a record that is run again (viewer::ResimulatedRun) have one.  It knows no inputs and no
/// branches: its owner delivers the inputs again after load(), and says what becomes of clients, pages and records.
class WorldTime {
 public:
  struct Limits {
    double kept_s = 0;  ///< simulated time for which states are kept; 0: none are
    std::size_t max_bytes = std::size_t{64} << 20;
  };
  /// All must outlive this.
  WorldTime(sim::World& world, sim::RunControl& control, Scoring& scoring, bridges::SimService& service,
            const Limits& limits);

  /// Returns the present state.  Throws sim::SnapshotError when the world has none.
  SavedRun save(History history) const;
  /// Sets the state.  Throws sim::SnapshotError.
  void load(const SavedRun& saved, History history);
  /// Sets scores and owners only.
  void load_beside(const SavedRun& saved, History history);

  /// Keeps the present state, if one is due: each simulated second, and less often in a world in which saving takes
  /// more than a small part of the time.  To be called before the first step, and after each.  `bytes_beside` count
  /// towards the limit.  Returns whether it was kept.  Throws as save().
  bool keep(std::size_t bytes_beside = 0);
  /// Keeps no more states, and forgets those that were kept.
  void stop_keeping();
  bool keeps() const { return keeps_; }
  std::optional<std::int64_t> oldest_kept() const { return kept_.oldest(); }
  std::optional<std::int64_t> newest_kept_until(std::int64_t step) const { return kept_.newest_until(step); }
  /// Sets a state that newest_kept_until() returned.
  void load_kept(std::int64_t step) { load(split(kept_.get(step)), History::length); }
  /// Forgets the states of later steps.
  void forget_after(std::int64_t step) { kept_.discard_after(step); }
  std::size_t bytes() const { return kept_.bytes(); }

  /// Executes a request to pause, resume, step, set the speed, or run until a time or an event (`text`).  Returns what
  /// a reply says after the place, such as `, takes 5 steps`; none for another request.  Throws std::runtime_error
  /// with the reason when it is refused.
  std::optional<std::string> execute(const std::string& command, const std::string& text, double value);
  /// Pauses a world that has reached what `until` has asked for.  Returns true when it did so now.
  bool stop_when_there();
  /// Returns the step that is so many seconds before the present one, but not before the first.  Throws
  /// std::runtime_error with the reason when there is none.
  std::int64_t step_before(double seconds, std::int64_t first_step) const;
  /// Returns the present place: `step 2000, 20 s`.
  std::string place() const;
  double seconds_at(std::int64_t step) const { return sim::to_seconds(world_.step_time() * step); }
  std::int64_t steps_per_second() const { return steps_per_second_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::string run_until(double time_s);
  std::string run_until_event(const std::string& name);

  sim::World& world_;
  sim::RunControl& control_;
  Scoring& scoring_;
  bridges::SimService& service_;
  const std::int64_t steps_per_second_;
  bool keeps_;
  SnapshotRing kept_;
  Clock::time_point not_before_{};  ///< wall time of the next state that is kept
};

}  // namespace experiment
