// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/control/run_audit.hpp"
#include "bridges/lockstep/lockstep_summary.hpp"
#include "sim/config/config_node.hpp"
#include "sim/director/script.hpp"
#include "sim/world/world.hpp"
#include "tools/experiment/results/summary_file.hpp"
#include "tools/experiment/score/judgement.hpp"
#include "tools/experiment/score/link_counts.hpp"
#include "tools/experiment/score/scoring.hpp"

namespace tools {

/// What a run came to: the same keys for every world.
struct Summary {
  /// A program that ended before the run did.
  struct Process {
    std::string name;
    std::string how;  ///< `exited with code 1`
    double sim_time_s = 0;
    bool failed = false;  ///< with an exit code, by a signal, or before its last tick; never with `on_exit: ignore`
  };

  std::string world;
  std::string description;  ///< of the world
  std::int64_t seed = 0;
  std::int64_t steps = 0;
  double sim_time_s = 0;
  double duration_s = 0;  ///< requested; 0: until a request to quit
  double wall_s = 0;
  std::uint64_t state_hash = 0;  ///< of the last state
  std::uint64_t run_hash = 0;    ///< of the whole run: WorldState::run_hash()
  std::uint64_t messages = 0;
  std::uint64_t dropped_messages = 0;
  std::int64_t bad_messages = 0;
  std::int64_t quick_steps = 0;
  std::map<std::string, double> metrics;
  std::vector<Scoring::Verdict> verdicts;
  std::string no_verdicts = "the world has no rules";  ///< why there are none, if so
  std::vector<Process> processes;
  std::vector<FirstContacts::Contact> contacts;   ///< of vehicles with each other and with objects
  std::vector<bridges::LockstepSummary> clients;  ///< that took part in the lockstep, by name
  bool needs_key = false;                         ///< control of the run needed its key
  std::int64_t refused_requests = 0;              ///< for want of the key
  std::vector<bridges::AuditEntry> audit;         ///< interventions such as quit or rewind: the first ones
  std::int64_t audit_count = 0;                   ///< of all
  std::map<std::string, sim::ZoneRecord> zones;   ///< by vehicle, when the world has zones with rules
  std::optional<LinkCounts> acoustics;            ///< of all modems under water, when there are any
  std::int64_t modem_dropped_messages = 0;        ///< that waited in queues of modems that were full
  std::uint64_t serial_dropped_bytes = 0;         ///< that no program fetched from pseudo-terminals and FIFOs
  std::optional<sim::EndOfRun> event;             ///< of the world that ended the run
  std::string ended =
      "duration";     ///< duration, event, quit, signal, rewound, fault, bus, timeout, process, configuration, error
  std::string error;  ///< why it ended early, empty when it did not
  int exit_code = 0;
  std::string version;      ///< of shoal
  std::int32_t branch = 0;  ///< how often the run went back before
  std::string snapshot;     ///< file that the run began with; empty: it began at 0
  double from_s = 0;        ///< since when the metrics count
  double stepped_s = 0;     ///< simulated in this process

  double real_time_factor() const { return wall_s > 0 ? stepped_s / wall_s : 0; }
  /// By the rules, the event that ended it, its programs, and whether it broke off.  A run that was ended by hand is
  /// not judged.
  Judgement judgement() const;
  bool judged() const { return judgement() != Judgement::not_judged; }
  /// Of a run that was not judged: `the world has no rules`, `ended by quit at 23 of 150 s`.
  std::string why_not_judged() const;
  /// By a request, a key or a signal, or by a rewind to another branch: its remainder is unknown.
  bool ended_by_hand() const { return ended == "quit" || ended == "signal" || ended == "rewound"; }
  /// Each program that failed is a rule that failed.
  void judge_processes();
  /// Each client with two different answers to one tick under its name counts as a failed rule.
  void judge_clients();
  void fail(int code, const std::string& how_ended, const std::string& why);
  std::string to_json() const;
  /// The end summary on a terminal.
  std::string to_text() const;
};

/// Writes DIRECTORY/summary.json; a reader finds it whole or not at all.  Makes the directory.  Throws
/// std::runtime_error.
void write_summary(const std::string& directory, const Summary& summary);
/// The same when there already is a more severe error.
void try_to_write_summary(const std::string& directory, const Summary& summary);

/// Writes the results directory: tracks while the run goes, the rest at its end.
class Results {
 public:
  /// Makes the directory.  Throws std::runtime_error with path and reason.
  Results(const std::string& directory, const sim::World& world, bool plots = true);
  ~Results();
  const std::string& directory() const { return directory_; }
  /// Adds a sample of every vehicle's true pose when one is due.
  void after_step();
  /// Why tracks cannot be written; looked at once a simulated second.
  std::optional<std::string> error() const { return error_; }
  /// Before a rewind: keeps the results of the abandoned branch in DIRECTORY/branchK, without plots.
  ///   Throws std::runtime_error.
  void keep_branch(const Summary& left, const Scoring& scoring, const sim::ConfigNode& resolved);
  /// Undoes keep_branch() when the rewind failed.
  void drop_branch();
  /// It has gone back: drops what the tracks know of later.  `ours`: the step is from this run; otherwise the tracks
  /// restart, as they hold those of another branch.  Throws std::runtime_error.
  void start_branch(sim::Time back_to, bool ours);
  /// summary.json once more, where something else could not be written.  Throws std::runtime_error.
  void write_summary_again(const Summary& summary) { summary_file_.write(summary.to_json()); }
  /// summary.json, metrics.csv, errors.csv, world.yaml and the plots.  Plotting ends once `give_up` returns true.
  /// What cannot be written does not keep the rest from being written.  Throws std::runtime_error about the first.
  void finish(const Summary& summary, const Scoring& scoring, const sim::ConfigNode& resolved,
              const std::function<bool()>& give_up);

 private:
  void write_outlines() const;
  void write_errors(const std::string& directory, const Scoring& scoring) const;
  void write_metrics(const std::string& directory, const Summary& summary) const;
  void close_tracks();
  void plot(const Summary& summary, const Scoring& scoring, const std::function<bool()>& give_up) const;
  void write(const std::string& file, const std::string& text) const;

  std::string directory_;
  SummaryFile summary_file_;
  const sim::World& world_;
  bool plots_;
  std::FILE* tracks_ = nullptr;
  std::string kept_;  ///< the directory that keep_branch() created for the present branch; empty: none
  std::int64_t every_steps_ = 1;
  std::int64_t steps_per_second_ = 1;
  std::optional<std::string> error_;
};

}  // namespace tools
