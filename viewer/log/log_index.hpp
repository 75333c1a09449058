// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "viewer/page_data/traffic_history.hpp"

namespace viewer {

/// Index of what a viewer needs in a log, by simulated time, built in one pass over the file.  Of a log with a rewind
/// (lcm-logger's) the last of overlapping parts counts.
class LogIndex {
 public:
  /// Event at a simulated time.
  struct Mark {
    std::int64_t time_us;
    std::uint64_t offset;  ///< in the file
  };
  /// Hash of the state after a step.
  struct Hash {
    std::int64_t time_us, step;
    std::uint64_t hash;
  };
  /// Event of the world, for the time line.
  struct Occasion {
    std::int64_t time_us;
    std::string kind, who, text;
  };
  /// Maximum number of occasions that are kept.
  static constexpr std::size_t max_occasions = 10'000;

  /// Reads the whole file.  `progress`: receives the share that was read, 0 to 1.  Throws BusError, and
  /// std::runtime_error when the log has nothing to show.
  explicit LogIndex(const std::string& path, const std::function<void(double share)>& progress = {});

  std::int64_t start_us() const { return bodies_.front().time_us; }
  std::int64_t end_us() const { return bodies_.back().time_us; }
  std::int64_t epoch_us() const { return epoch_us_; }
  const std::string& world() const { return world_; }
  const std::vector<Occasion>& occasions() const { return occasions_; }
  const std::vector<std::string>& problems() const { return problems_; }
  /// Return the last message of a kind at or before a time; that at the start for an earlier time.
  Mark bodies_at(std::int64_t time_us) const { return *last(bodies_, time_us); }
  Mark scene_at(std::int64_t time_us) const { return *last(scenes_, time_us); }
  std::optional<Mark> scores_at(std::int64_t time_us) const;
  /// Returns the offsets of the last path (shoal.waypoints_command_t) of each channel at or before a time.
  std::vector<std::uint64_t> paths_at(std::int64_t time_us) const;
  const std::vector<Mark>& bodies() const { return bodies_; }
  /// Returns the first hash of each step that has one, in the order of the steps.
  const std::vector<Hash>& hashes() const { return hashes_; }
  /// Returns the offsets of all assets.
  const std::vector<std::uint64_t>& assets() const { return assets_; }
  /// Returns the counts of all messages before some event at or before a place in the log, at most a second earlier.
  TrafficHistory::Point counts_before(std::uint64_t offset) const { return traffic_.before(offset); }

 private:
  static const Mark* last(const std::vector<Mark>& marks, std::int64_t time_us);
  static void add(std::vector<Mark>& marks, const Mark& mark);
  void mark_traffic(const Mark& mark, TrafficCounts& counts);
  void add_hash(const Hash& hash);
  void check(const std::string& path) const;

  std::int64_t epoch_us_ = 0;
  bool has_info_ = false;  // of the run, with its world
  std::string world_;
  std::vector<Mark> bodies_, scenes_, scores_;
  std::map<std::string, std::vector<Mark>, std::less<>> paths_;  // by channel
  std::vector<Hash> hashes_;
  std::vector<std::uint64_t> assets_;
  std::vector<Occasion> occasions_;
  std::vector<std::string> problems_;
  TrafficHistory traffic_;
};

}  // namespace viewer
