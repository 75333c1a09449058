// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "tools/experiment/page_data/traffic_counts.hpp"

namespace tools {

/// Counts of a log at marks along it, some one per second.  Only what has changed since the mark before takes memory.
class TrafficHistory {
 public:
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

  static void set(Values& values, std::uint32_t marks, std::int64_t value);
  static std::int64_t get(const Values& values, std::size_t marks);
  TrafficCounts restore(std::size_t marks) const;
  template <typename Use>
  void for_each(Use&& use);

  std::vector<Mark> marks_;
  std::map<std::string, ChannelValues, std::less<>> channels_;
  std::map<TrafficCounts::Names, Values> sent_;
  std::map<std::tuple<std::string, std::string, std::string>, Values> received_;  // last: outcome; empty: received
};

}  // namespace tools
