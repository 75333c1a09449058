// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"

namespace tools {

/// A file that is not a snapshot, or none that this program can continue from.  what() says file, rule and value.
class SnapshotFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A world at one step, with what is needed to build it again.
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
  double from_s = 0;  ///< since when the scores count
  std::uint64_t state_hash = 0;
  std::vector<std::string> vehicles;
  sim::Bytes state;   ///< WorldState::snapshot()
  sim::Bytes scores;  ///< Scoring::visit_state()
  sim::Bytes owners;  ///< SimService::visit_state()

  double time_s() const { return static_cast<double>(step * step_us) * 1e-6; }
  /// Time stamp of messages of this step.
  std::int64_t utime() const { return epoch_us + step * step_us; }
};

/// The bytes of a snapshot file: eight letters, format version, content, checksum.
sim::Bytes to_bytes(const Snapshot& snapshot);
/// Throws SnapshotFileError: foreign, cut off, damaged, of another format.  `path` is for the error.
Snapshot snapshot_from_bytes(const sim::Bytes& bytes, const std::string& path);

/// A reader finds the file whole or not at all.  Throws SnapshotFileError when it cannot be written.
void write_snapshot(const std::string& path, const Snapshot& snapshot);
/// Throws SnapshotFileError.
Snapshot read_snapshot(const std::string& path);
/// Throws SnapshotFileError when another build of shoal wrote it: the order of the state may have changed.
void check_version(const Snapshot& snapshot, const std::string& path, const std::string& own_version);
/// Throws SnapshotFileError when a file that its world names is gone, or is another one.
void check_files(const Snapshot& snapshot, const std::string& path);

}  // namespace tools
