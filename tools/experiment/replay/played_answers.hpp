// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bus/message_gate.hpp"
#include "tools/experiment/replay/replay_log.hpp"

namespace tools {

/// Compares what programs publish during the playback of a record with the inputs of the world in its run: by step
/// and channel, in order.  Channels on which no program has spoken yet are another program's.
class PlayedAnswers {
 public:
  struct Channel {
    std::int64_t equal = 0, different = 0;
    std::int64_t missing = 0;                ///< in the record, not published here
    std::int64_t added = 0;                  ///< published here, not in the record
    std::optional<std::int64_t> first_step;  ///< at which something differs
    std::string first;                       ///< what, in words
    bool spoken = false;                     ///< a program published on it here
    std::int64_t recorded = 0;
  };

  /// `log` must outlive this.
  explicit PlayedAnswers(const ReplayLog& log);

  /// Channels on which something came to the world from outside.
  const std::map<std::string, Channel, std::less<>>& channels() const { return channels_; }
  /// What came after `step`, in order.  To be called once for each step, in ascending order.
  void came(std::int64_t step, std::span<const sim::MessageGate::Delivery> input_record);
  /// A program has published on this channel.
  bool is_spoken(std::string_view channel) const;

  bool all_equal() const;
  /// One line for each channel on which a program spoke, then what was not spoken.
  std::vector<std::string> to_lines(double step_s) const;

 private:
  void compare(Channel& channel, std::int64_t step, const std::vector<const sim::Bytes*>& there,
               const std::vector<const sim::Bytes*>& here);

  const ReplayLog& log_;
  std::size_t next_ = 0;  // of the inputs
  std::map<std::string, Channel, std::less<>> channels_;
};

}  // namespace tools
