// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"

namespace experiment {

/// Error of a file that is not a snapshot, or one that this program cannot continue from.  what() contains file, rule
/// and value.
class SnapshotFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// State of a world at one step, with the data needed to build the world again.
struct Snapshot {
  std::string version;         ///< of shoal that wrote it
  std::string world;           ///< its name
  std::string resolved_world;  ///< YAML
  std::string files;           ///< hashes of the files that it names: files_text()
  std::int64_t seed = 0;
  std::int64_t epoch_us = 0;
  std::int64_t step_us = 0;
  std::int64_t step = 0;
  std::int32_t branch = 0;
  double from_s = 0;  ///< start of the scores
  std::uint64_t state_hash = 0;
  std::vector<std::string> vehicles;
  sim::Bytes state;   ///< WorldState::snapshot()
  sim::Bytes scores;  ///< Scoring::visit_state()
  sim::Bytes owners;  ///< SimService::visit_state()

  double time_s() const { return static_cast<double>(step * step_us) * 1e-6; }
  /// Returns the time stamp of messages of this step.
  std::int64_t utime() const { return epoch_us + step * step_us; }
};

/// Returns the content of a snapshot file: eight letters, format version, content, checksum.
sim::Bytes to_bytes(const Snapshot& snapshot);
/// Throws SnapshotFileError for a file that is not a snapshot, truncated, damaged, or of another format.  `path` is for
/// the error.
Snapshot snapshot_from_bytes(const sim::Bytes& bytes, const std::string& path);

/// Writes the file atomically.  Throws SnapshotFileError when it cannot be written.
void write_snapshot(const std::string& path, const Snapshot& snapshot);
/// Reads a snapshot file.  Throws SnapshotFileError.
Snapshot read_snapshot(const std::string& path);
/// Throws SnapshotFileError when another build of shoal wrote it: the order of the state may have changed.
void check_version(const Snapshot& snapshot, const std::string& path, const std::string& own_version);
/// Throws SnapshotFileError when a file that its world names is missing or has changed.
void check_files(const Snapshot& snapshot, const std::string& path);

}  // namespace experiment
