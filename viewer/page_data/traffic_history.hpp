// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "viewer/page_data/traffic_counts.hpp"

namespace viewer {

/// Counts of a log at marks along it, some one per second, or of a run.  Only what has changed since the mark before
/// takes memory; when there is too much of it, the marks of the older half are kept twice as far
/// apart.
class TrafficHistory {
 public:
  /// Maximum number of values, of 16 bytes each.
  static constexpr std::size_t max_values = std::size_t{1} << 20;

  explicit TrafficHistory(std::size_t limit = max_values) : limit_(limit) {}

  /// Counts before a place in the log.
  struct Point {
    TrafficCounts counts;
    std::uint64_t offset = 0;  ///< of the first event that is not counted
  };

  /// Adds a mark with the counts of all events before `offset`.  Marks come in the order of time.
  void mark(std::int64_t time_us, std::uint64_t offset, const TrafficCounts& counts);
  /// Removes the marks after a time, because the run was rewound; returns false if there are none.
  bool rewind(std::int64_t time_us);
  /// Returns the time of the last mark; that there is none: the smallest time.
  std::int64_t last_us() const;
  /// Returns the counts at the last mark.
  TrafficCounts last() const { return restore(marks_.size()); }
  /// Returns the counts at the last mark at or before a place in the log; nothing counted at its start.
  Point before(std::uint64_t offset) const;

 private:
  struct Mark {
    std::int64_t time_us;
    std::uint64_t offset;
  };
  /// Value from a mark on.
  struct Value {
    std::uint32_t marks;  ///< number of marks including it
    std::int64_t value;
  };
  using Values = std::vector<Value>;
  struct ChannelValues {
    std::uint64_t fingerprint = 0;
    Values count, bytes;
  };

  struct SenderValues {
    Values count, bytes, sending_us;
  };

  void set(Values& values, std::uint32_t marks, std::int64_t value);
  void thin();
  static std::int64_t get(const Values& values, std::size_t marks);
  TrafficCounts restore(std::size_t marks) const;
  template <typename Use>
  void for_each(Use&& use);

  std::size_t limit_;
  std::size_t size_ = 0;  // number of values
  std::vector<Mark> marks_;
  std::map<std::string, ChannelValues, std::less<>> channels_;
  std::map<TrafficCounts::Names, Values> sent_;
  std::map<std::string, SenderValues> senders_;
  std::map<std::tuple<std::string, std::string, std::string>, Values> links_;  // last: outcome; empty: received
};

}  // namespace viewer
