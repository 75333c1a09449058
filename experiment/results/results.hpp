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
#include "bridges/lockstep/lockstep_service.hpp"
#include "experiment/results/summary_file.hpp"
#include "experiment/score/link_counts.hpp"
#include "experiment/score/rule_verdict.hpp"
#include "experiment/score/scoring.hpp"
#include "sim/config/config_node.hpp"
#include "sim/director/script.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Summary of a run, with the same keys for every world.
struct Summary {
  /// Program that ended before the run did.
  struct Process {
    std::string name;
    std::string how;  ///< `exited with code 1`
    double sim_time_s = 0;
    bool failed = false;  ///< with an exit code, by a signal, or before its last tick; never with `on_exit: ignore`
  };

  /// Message that a shadow took.
  struct Shadowed {
    double sent_s = 0;
    std::string from, to;  ///< vehicle and device
    double range_m = 0;
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
  std::string threads_advice;  ///< SharedWork::advice(); empty: none
  std::map<std::string, double> metrics;
  std::vector<Scoring::Verdict> verdicts;
  std::string no_verdicts = "the world has no rules";  ///< why there are no verdicts, if so
  std::vector<Process> processes;
  std::vector<FirstContacts::Contact> contacts;   ///< of vehicles with each other and with objects
  std::vector<bridges::LockstepSummary> clients;  ///< that took part in the lockstep, by name
  std::vector<std::string> not_recorded;          ///< what clients published and the record lacks
  std::vector<std::string> not_repeatable;        ///< what acted on the run at times of its own: `bridge moos`
  std::vector<std::string> warnings;              ///< of the end of the run, one line each
  bool needs_key = false;                         ///< control of the run needed its key
  std::int64_t refused_requests = 0;              ///< for lack of the key
  std::vector<bridges::AuditEntry> audit;         ///< interventions such as quit or rewind: the first ones
  std::int64_t audit_count = 0;                   ///< number of all interventions
  std::map<std::string, sim::ZoneRecord> zones;   ///< by vehicle, when the world has zones with rules
  std::optional<LinkCounts> acoustics;            ///< of all underwater modems, if any
  std::vector<std::string> acoustic_effects;      ///< AcousticChannel::effects()
  std::vector<Shadowed> shadowed;                 ///< messages that shadows took: the first ones
  std::int64_t modem_dropped_messages = 0;        ///< that waited in queues of modems that were full
  std::uint64_t serial_dropped_bytes = 0;         ///< not read by any program from pseudo-terminals and FIFOs
  std::optional<sim::EndOfRun> event;             ///< of the world that ended the run
  std::string ended = "duration";  ///< duration, event, quit, changed, signal, rewound, fault, bus, timeout, process,
                                   ///< configuration, error
  std::string error;               ///< why it ended early, empty when it did not
  int exit_code = 0;
  std::string version;      ///< of shoal
  std::string build;        ///< processor class and C library, see build_text()
  std::int32_t branch = 0;  ///< number of earlier rewinds
  std::string snapshot;     ///< file that the run started from; empty: it started at 0
  double from_s = 0;        ///< start of the metrics
  double stepped_s = 0;     ///< simulated in this process

  double real_time_factor() const { return wall_s > 0 ? stepped_s / wall_s : 0; }
  /// Judges the run by the rules, the event that ended it, its programs, and whether it was aborted.  A run that was
  /// ended manually is not judged.
  Judgement judgement() const;
  bool judged() const { return judgement() != Judgement::not_judged; }
  /// Returns the reason for a run that was not judged: `the world has no rules`, `ended by quit at 23 of 150 s`.
  std::string why_not_judged() const;
  /// Returns whether a request, a key, a signal or a rewind to another branch ended the run: its remainder is unknown.
  bool ended_by_hand() const {
    return ended == "quit" || ended == "changed" || ended == "signal" || ended == "rewound";
  }
  /// Adds each failed program as a failed rule.
  void judge_processes();
  /// Adds each client with two different answers to one tick under its name as a failed rule.
  void judge_clients();
  void fail(int code, const std::string& how_ended, const std::string& why);
  std::string to_json() const;
  /// Returns the end summary for a terminal.
  std::string to_text() const;
};

/// Writes DIRECTORY/summary.json atomically.  Creates the directory.  Throws std::runtime_error.
void write_summary(const std::string& directory, const Summary& summary);
/// Does the same without throwing, when there already is a more severe error.
void try_to_write_summary(const std::string& directory, const Summary& summary);

/// Writer of the results directory: tracks during the run, everything else at its end.
class Results {
 public:
  /// Creates the directory.  Throws std::runtime_error with path and reason.
  Results(const std::string& directory, const sim::World& world, bool plots = true);
  ~Results();
  const std::string& directory() const { return directory_; }
  /// Adds a sample of every vehicle's true pose when one is due.
  void after_step();
  /// Returns why tracks cannot be written; checked once per simulated second.
  std::optional<std::string> error() const { return error_; }
  /// Keeps the results of the abandoned branch in DIRECTORY/branchK, without plots; to be called before a rewind.
  /// Throws std::runtime_error.
  void keep_branch(const Summary& left, const Scoring& scoring, const sim::ConfigNode& resolved);
  /// Undoes keep_branch() when the rewind failed.
  void drop_branch();
  /// Removes the part of the tracks after `back_to`, once the rewind is done.  `ours`: the step is from this run;
  /// otherwise the tracks restart, because they hold those of another branch.  Throws std::runtime_error.
  void start_branch(sim::Time back_to, bool ours);
  /// Writes summary.json once more, after another file could not be written.  Throws std::runtime_error.
  void write_summary_again(const Summary& summary) { summary_file_.write(summary.to_json()); }
  /// Writes summary.json, metrics.csv, errors.csv, world.yaml and the plots.  Plotting ends once `give_up` returns
  /// true. A file that cannot be written does not prevent the others.  Throws std::runtime_error about the first error.
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

}  // namespace experiment
