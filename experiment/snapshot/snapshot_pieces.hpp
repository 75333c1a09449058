// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/snapshot/snapshot_file.hpp"
#include "shoal/sim_snapshot_t.hpp"
#include "sim/bus/bus.hpp"

namespace experiment {

/// Splits a snapshot into messages for `sim.snapshot`, each of at most 60 kB, so that one fits into a datagram.  The
/// scores are omitted, because they do not influence the run.
std::vector<shoal::sim_snapshot_t> in_pieces(const Snapshot& snapshot, std::int32_t branch,
                                             std::int64_t input_sequence);

/// Reassembles the pieces.  They come from a log: some may be missing, duplicated or forged.
class SnapshotPieces {
 public:
  /// Returns the bytes of the snapshot file after the last piece.  Throws shoal::MessageError for an invalid piece, or
  /// one that follows lost pieces.
  std::optional<sim::Bytes> add(const shoal::sim_snapshot_t& piece);
  /// Returns what is missing of the last snapshot, such as `pieces 3 to 4 of 7 of the snapshot of step 1000 are
  /// missing`; empty: nothing.
  std::string missing() const;

 private:
  bool continues(const shoal::sim_snapshot_t& piece) const;

  std::optional<shoal::sim_snapshot_t> first_;  // without its data
  std::int32_t next_ = 0;                       // piece that comes next
  std::int32_t lost_until_ = 0;                 // pieces before this one are lost, from next_ on
  sim::Bytes bytes_;
};

}  // namespace experiment
