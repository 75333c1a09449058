// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bridges/log/event_log.hpp"
#include "experiment/replay/read_ahead.hpp"
#include "experiment/replay/replay_log.hpp"

namespace experiment {

/// Describes how a message of this replay differs from one of a log, such as `x_m is 1.25 in the log and 1.26 here`.
std::string message_difference(std::span<const std::byte> logged, std::span<const std::byte> here);

/// Compares the messages of a replayed world with those in its log: byte by byte, in order per channel. Messages that
/// the log lacks are counted; in a record that was not thinned, which has no losses, they are differences.
class ReplayMessages {
 public:
  struct Difference {
    std::int64_t step = 0;
    std::string channel;
    std::string what;  ///< such as `velocity_mps[0] is 1.25 in the log and 1.26 here`
  };
  struct Distance {
    double max_m = 0;
    std::int64_t max_step = 0;
    std::int64_t first_step = 0;
  };

  /// `log` must outlive this.
  explicit ReplayMessages(const ReplayLog& log);

  /// Compares a message that was published at the end of `step` in this replay.
  void published(std::string_view channel, std::span<const std::byte> payload, std::int64_t step);
  /// To be called after the last step.
  void finish(std::int64_t step);

  std::uint64_t equal() const { return equal_; }
  std::uint64_t different() const { return different_; }
  /// Number of messages published here and missing in the log.
  std::uint64_t missing() const { return missing_; }
  /// First of those; null: none.
  const Difference* first_missing() const { return first_missing_ ? &*first_missing_ : nullptr; }
  /// First difference in order of discovery; null: none.
  const Difference* first() const { return first_ ? &*first_ : nullptr; }
  /// First difference on sim.state of a vehicle that is in the log as well; null: none.
  const Difference* first_motion() const { return first_motion_ ? &*first_motion_ : nullptr; }
  /// First difference on each channel.
  const std::map<std::string, Difference>& by_channel() const { return by_channel_; }
  /// Distances of vehicles whose true positions differ, by name.
  const std::map<std::string, Distance>& distances() const { return distances_; }

 private:
  using Payload = std::span<const std::byte>;
  struct Channel {
    std::string_view name;
    std::deque<sim::Bytes> queue;             // read from the log and not yet compared
    std::uint64_t left = 0;                   // in the log, including those in the queue
    std::multiset<std::size_t> input_record;  // hashes of its input messages
    bool published = false;
    /// Successor of this channel the last time: the order of channels repeats, which saves a search for the name.
    Channel *next_published = nullptr, *next_read = nullptr;
  };

  Channel* find(std::string_view name) const {
    const auto known = by_name_.find(name);
    return known == by_name_.end() ? nullptr : known->second;
  }
  /// Tries the previous successor of `last`; sets `last` to the channel that is found.
  Channel* find_next(std::string_view name, Channel*& last, Channel* Channel::*next);
  Channel& add(std::string_view name);
  /// Returns the next logged message; null: the log has no more of them, or none before the message being compared.
  std::optional<Payload> head(Channel& channel);
  void pop(Channel& channel);
  bool is_input(Channel& channel, Payload payload);
  void differ(std::string_view channel, std::int64_t step, const std::string& what);
  void compare_states(Payload logged, Payload here, std::int64_t step);

  const ReplayLog& log_;
  ReadAhead file_;
  bool at_end_ = false;
  std::int64_t look_until_ = 0;   // time stamp up to which a record is read
  std::size_t queued_bytes_ = 0;  // of all channels
  bridges::LogEventView event_;   // last event read
  Channel *last_published_ = nullptr, *last_read_ = nullptr;
  Channel* current_ = nullptr;  // owner of the event until it is compared; null: compared, or without owner
  std::map<std::string, Channel, std::less<>> channels_;
  std::unordered_map<std::string_view, Channel*> by_name_;  // only for lookup, never iterated
  std::uint64_t equal_ = 0, different_ = 0, missing_ = 0;
  std::optional<Difference> first_, first_motion_, first_missing_;
  std::map<std::string, Difference> by_channel_;
  std::map<std::string, Distance> distances_;
};

}  // namespace experiment
