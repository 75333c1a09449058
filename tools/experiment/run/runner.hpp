// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/world_file/load_world.hpp"
#include "tools/experiment/process/signals.hpp"
#include "tools/experiment/results/results.hpp"
#include "tools/experiment/snapshot/snapshot_file.hpp"

namespace tools {

/// What the command line asks of a run.
struct RunOptions {
  std::optional<double> duration_s;  ///< instead of the world's
  std::optional<double> speed;       ///< instead of the world's; 0: as fast as possible
  std::string bus = "lcm";           ///< lcm, none
  std::string lcm_url;               ///< empty: LCM_DEFAULT_URL, then the default
  bool lcm_shared = false;           ///< other simulators may be on the same buses
  bool control_key = false;          ///< control needs the run's key, also on a bus of this machine
  bool open_control = false;         ///< control needs no key, also on a bus that leaves this machine
  std::string record;                ///< file for the LCM event log; empty: none
  bool overwrite = false;            ///< of the record
  bool special_files = false;        ///< the record may be a pipe or a device
  std::string results;               ///< directory; empty: none
  std::string name = "run";          ///< what {run} stands for in paths of serial ports and in commands of processes
  bool plots = true;                 ///< in the results
  bool paused = false;
  bool launch = false;
  std::vector<std::string> await;  ///< lockstep clients, started by hand, to wait for
  bool serial_ports = true;        ///< pseudo-terminals and FIFOs of devices are opened
  int threads = 0;                 ///< that follow rays; 0: one for each processor
  bool quiet = false;
  bool keys = true;                        ///< keys of the terminal are executed, when there is one
  std::optional<Snapshot> from;            ///< the run continues from there
  std::string from_file;                   ///< its name
  std::string snapshots;                   ///< directory of snapshot files; empty: `snapshots` in the results
  std::vector<double> snapshot_at_s;       ///< when to write one, in simulated time
  std::optional<double> snapshot_every_s;  ///< and how often
  std::optional<double> rewind_s;          ///< how far a run can be rewound; without it 60 s when requests are possible
  double rewind_MB = 64;                   ///< memory for that
};

/// Runs a world to its end: builds it, opens the bus and the record, starts the processes, steps, paces, waits for
/// lockstep clients, scores, writes the results.  Errors end up in the summary with their exit code; nothing is
/// thrown but ConfigError.
Summary run_world(const sim::LoadedWorld& loaded, const RunOptions& options);

/// Versions of shoal and of the libraries it runs with.
std::string version_text();
/// Of shoal alone: `0.5.0 (a1b2c3d)`.
std::string short_version();

}  // namespace tools
