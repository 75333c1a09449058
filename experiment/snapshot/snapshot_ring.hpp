// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"

namespace experiment {

/// Snapshots of the last seconds in memory.  Every few snapshots one is stored in full; the others are stored as the
/// difference from the preceding full one.  They are compressed when space is short.  Number and bytes are limited: the
/// oldest are removed first, together with the full snapshot that they depend on.
class SnapshotRing {
 public:
  /// Keeps snapshots of the last `steps` steps, but never more than `max_bytes`; always keeps the newest one.
  SnapshotRing(std::int64_t steps, std::size_t max_bytes) : steps_(steps), max_bytes_(max_bytes) {}

  /// Adds a snapshot; `step` must be larger than that of the newest.  `bytes_beside` count towards the limit.
  void add(std::int64_t step, const sim::Bytes& snapshot, std::size_t bytes_beside = 0);
  /// Returns the step of the newest snapshot that is not later than `step`.
  std::optional<std::int64_t> newest_until(std::int64_t step) const;
  /// Returns the snapshot of a step that newest_until() returned.
  sim::Bytes get(std::int64_t step) const;
  /// Removes all snapshots later than `step`.
  void discard_after(std::int64_t step);
  /// Returns the step of the oldest snapshot.
  std::optional<std::int64_t> oldest() const;
  std::size_t size() const { return count_; }
  /// Number of bytes held in memory.
  std::size_t bytes() const { return bytes_ + whole_.size() + difference_.size(); }

 private:
  /// Snapshot, or its difference from another.
  struct Packed {
    std::int64_t step;
    sim::Bytes bytes;
    bool deflated;
    sim::Bytes unpacked() const;
  };
  /// Full snapshot, and the differences that depend on it.
  struct Family {
    Packed whole;
    std::vector<Packed> others;
    std::size_t bytes() const;
  };

  Packed pack(std::int64_t step, std::span<const std::byte> bytes) const;
  std::int64_t newest() const;
  const Family* family_of(std::int64_t step) const;

  std::int64_t steps_;
  std::size_t max_bytes_;
  std::deque<Family> families_;
  sim::Bytes whole_;       // the newest family's, not packed
  sim::Bytes difference_;  // reused memory
  std::size_t bytes_ = 0, count_ = 0;
};

}  // namespace experiment
