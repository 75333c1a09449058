// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "shoal/sim_info_t.hpp"

namespace tools {

/// The end of a record as its own log.
struct RecordTail {
  shoal::sim_info_t info{};  ///< of the run
  double start_s = 0;        ///< simulated time of the first event that was kept
  double end_s = 0;          ///< of the last one
  std::uint64_t events = 0;  ///< beside sim.info and the snapshot
  bool whole = false;        ///< all of the record is in it
  std::string snapshot;      ///< what it begins with, in words; empty: with no snapshot
  std::string short_of;      ///< why it is shorter than was asked for; empty: it is not

  /// `shoal replay` can run it again.
  bool replayable() const { return whole || !snapshot.empty(); }
};

struct TailOptions {
  double last_s = 10;                                 ///< simulated seconds at least, where the record has them
  std::uint64_t max_bytes = std::uint64_t{64} << 20;  ///< of the new log
  std::string snapshots;                              ///< a folder of snapshot files of the run; empty: none
};

/// Writes the last seconds of a record into another log.  It starts with sim.info, and with the last snapshot before
/// those seconds where the record, or the folder of snapshots, has one that is at most a minute earlier: then it can be
/// run again.  Throws std::runtime_error: `record` cannot be read or is not a log of a run; `out` cannot be written.
RecordTail write_record_tail(const std::string& record, const std::string& out, const TailOptions& options);

}  // namespace tools
