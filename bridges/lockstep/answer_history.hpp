// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "shoal/sim_ack_t.hpp"

namespace bridges {

/// History of the last answers of one client, to detect two different answers to one tick.
class AnswerHistory {
 public:
  /// Length of the history, greater than the delay of a client whose ticks another program answers.
  static constexpr std::size_t max_answers = 64;

  /// Adds an answer and describes how it differs from the first one to its tick; none when it is the first, or equal.
  /// `utime` is ignored.
  std::optional<std::string> add(const shoal::sim_ack_t& ack);
  /// Starts a branch after a rewind: a client without session may answer the same step again.
  void set_branch();

 private:
  struct Answer {
    std::int64_t session, sequence, step;
    bool listed;
    std::int32_t count;
    std::uint64_t hash;  // hash of the list
  };
  std::deque<Answer> answers_;
};

}  // namespace bridges
