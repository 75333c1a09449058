// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "shoal/sim_ack_t.hpp"

namespace bridges {

/// The last answers of one client, to find two different ones to one tick.
class AnswerHistory {
 public:
  /// More than the lag of a client whose ticks another program answers.
  static constexpr std::size_t max_answers = 64;

  /// Describes how an answer differs from the first one to its tick; nothing when it is the first, or equal.  `utime`
  /// does not count.
  std::optional<std::string> add(const shoal::sim_ack_t& ack);
  /// The world went back: a client without session may answer the same step again.
  void set_branch();

 private:
  struct Answer {
    std::int64_t session, sequence, step;
    bool listed;
    std::int32_t count;
    std::uint64_t hash;  // of the list
  };
  std::deque<Answer> answers_;
};

}  // namespace bridges
