// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "shoal/sim_info_t.hpp"

namespace experiment {

/// End of a record as a separate log.
struct RecordTail {
  shoal::sim_info_t info{};  ///< of the run
  double start_s = 0;        ///< simulated time of the first event that was kept
  double end_s = 0;          ///< of the last one
  std::uint64_t events = 0;  ///< without sim.info and the snapshot
  bool whole = false;        ///< contains the entire record
  std::string snapshot;      ///< description of the initial snapshot; empty: no snapshot
  std::string short_of;      ///< why it is shorter than requested; empty: it is not

  /// Returns whether `shoal replay` can replay it.
  bool replayable() const { return whole || !snapshot.empty(); }
};

struct TailOptions {
  double last_s = 10;                                 ///< minimum simulated seconds, where the record has them
  std::uint64_t max_bytes = std::uint64_t{64} << 20;  ///< of the new log
  std::string snapshots;                              ///< a folder of snapshot files of the run; empty: none
};

/// Writes the last seconds of a record into another log.  It starts with sim.info, and with the last snapshot before
/// those seconds if the record, or the folder of snapshots, has one that is at most a minute earlier; with a snapshot
/// it can be replayed.  Throws std::runtime_error when `record` cannot be read or is not a log of a run, or `out`
/// cannot be written.
RecordTail write_record_tail(const std::string& record, const std::string& out, const TailOptions& options);

}  // namespace experiment
