// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/process/signals.hpp"
#include "experiment/results/results.hpp"
#include "experiment/run/run_page.hpp"
#include "experiment/snapshot/snapshot_file.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// Command-line options of a run.
struct RunOptions {
  std::optional<double> duration_s;  ///< instead of the world's
  std::optional<double> speed;       ///< instead of the world's; 0: as fast as possible
  std::string bus = "lcm";           ///< lcm, none
  std::string lcm_url;               ///< empty: LCM_DEFAULT_URL, then the default
  bool lcm_shared = false;           ///< other simulators may be on the same buses
  bool control_key = false;          ///< control needs the run's key, also on a bus of this machine
  bool open_control = false;         ///< control needs no key, also on a bus that leaves this machine
  std::string record;                ///< file for the LCM event log; empty: none
  std::optional<double> record_mb;   ///< budget of the record in MB; unset: no limit
  bool overwrite = false;            ///< replaces an existing record
  bool special_files = false;        ///< the record may be a pipe or a device
  std::string results;               ///< directory; empty: none
  std::string name = "run";          ///< replaces {run} in paths of serial ports and in commands of processes
  bool plots = true;                 ///< in the results
  bool paused = false;
  bool launch = false;
  std::vector<std::string> await;  ///< lockstep clients, started by hand, to wait for
  bool serial_ports = true;        ///< pseudo-terminals and FIFOs of devices are opened
  int threads = 0;                 ///< threads that share a step; 0: one for each processor
  bool quiet = false;
  bool keys = true;                        ///< executes keys of the terminal, if there is one
  std::optional<Snapshot> from;            ///< snapshot that the run continues from
  std::string from_file;                   ///< file name of that snapshot
  std::string snapshots;                   ///< directory of snapshot files; empty: `snapshots` in the results
  std::vector<double> snapshot_at_s;       ///< simulated times of snapshot files
  std::optional<double> snapshot_every_s;  ///< interval of snapshot files
  std::optional<double> rewind_s;          ///< longest rewind; unset: 60 s when requests are possible
  double rewind_MB = 64;                   ///< memory for rewinding
  RunPage::Make page = {};                 ///< makes the live page; empty: there is none
  std::function<bool()> leave = {};        ///< asked in each step: true ends the run; empty: nothing does so
};

/// Runs a world to its end: builds it, opens the bus and the record, starts the processes, steps, paces, waits for
/// lockstep clients, scores, writes the results.  Errors are reported in the summary with their exit code; only
/// ConfigError is thrown.
Summary run_world(const sim::LoadedWorld& loaded, const RunOptions& options);

/// Returns the command that reports a failed run; `results` and `record` as of `shoal run`, empty: none.
std::string bug_hint(const std::string& results, const std::string& record);

}  // namespace experiment
