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

#include "experiment/replay/replay_log.hpp"
#include "sim/bus/message_gate.hpp"

namespace experiment {

/// Compares the messages that programs publish during the playback of a record with the inputs of the world in its run:
/// by step and channel, in order.  Channels on which no program has published yet belong to other programs.
class PlayedAnswers {
 public:
  struct Channel {
    std::int64_t equal = 0, different = 0;
    std::int64_t missing = 0;                ///< in the record, not published here
    std::int64_t added = 0;                  ///< published here, not in the record
    std::optional<std::int64_t> first_step;  ///< first step with a difference
    std::string first;                       ///< description of the first difference
    bool spoken = false;                     ///< a program published on it in this playback
    std::int64_t recorded = 0;
  };

  /// `log` must outlive this.
  explicit PlayedAnswers(const ReplayLog& log);

  /// Channels on which the world received inputs.
  const std::map<std::string, Channel, std::less<>>& channels() const { return channels_; }
  /// Compares the messages that arrived after `step`, in order.  To be called once for each step, in ascending order.
  void came(std::int64_t step, std::span<const sim::MessageGate::Delivery> input_record);
  /// Returns whether a program has published on this channel.
  bool is_spoken(std::string_view channel) const;

  bool all_equal() const;
  /// Returns one line for each channel on which a program published, then the channels without any.
  std::vector<std::string> to_lines(double step_s) const;

 private:
  void compare(Channel& channel, std::int64_t step, const std::vector<const sim::Bytes*>& there,
               const std::vector<const sim::Bytes*>& here);

  const ReplayLog& log_;
  std::size_t next_ = 0;  // of the inputs
  std::map<std::string, Channel, std::less<>> channels_;
};

}  // namespace experiment
