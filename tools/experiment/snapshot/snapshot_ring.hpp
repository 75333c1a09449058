// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"

namespace tools {

/// Snapshots of the last seconds in memory.  Every few are kept whole; of those between, what differs from the whole
/// one before is kept.  Compressed where there is no room without.  Bounded in number and bytes: the oldest go first,
/// together with the whole one that they tilt on.
class SnapshotRing {
 public:
  /// Snapshots are kept for `steps` steps, but never more than `max_bytes` of them; the newest one always is.
  SnapshotRing(std::int64_t steps, std::size_t max_bytes) : steps_(steps), max_bytes_(max_bytes) {}

  /// `step` must be larger than that of the newest.  `bytes_beside` count as well.
  void add(std::int64_t step, const sim::Bytes& snapshot, std::size_t bytes_beside = 0);
  /// The step of the newest snapshot that is not later than `step`.
  std::optional<std::int64_t> newest_until(std::int64_t step) const;
  /// The snapshot of a step that newest_until() gave.
  sim::Bytes get(std::int64_t step) const;
  /// Drops all that are later than `step`.
  void discard_after(std::int64_t step);
  /// The step of the oldest one.
  std::optional<std::int64_t> oldest() const;
  std::size_t size() const { return count_; }
  /// That it holds in memory.
  std::size_t bytes() const { return bytes_ + whole_.size() + difference_.size(); }

 private:
  /// A snapshot, or how it differs from another.
  struct Packed {
    std::int64_t step;
    sim::Bytes bytes;
    bool deflated;
    sim::Bytes unpacked() const;
  };
  /// A whole snapshot, and those that tilt on it.
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
  sim::Bytes difference_;  // memory that is used again
  std::size_t bytes_ = 0, count_ = 0;
};

}  // namespace tools
