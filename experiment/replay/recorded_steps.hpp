// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "bridges/log/event_log.hpp"
#include "experiment/replay/replay_log.hpp"

namespace experiment {

/// Reader of the messages of a record step by step, in the order in which the run delivered them: the inputs of the
/// world before a step, then the messages that the simulator published at its end.  Messages of the run itself
/// (lockstep, requests, sim.inputs, sim.hash, sim.snapshot) are omitted, and so is the first sim.info.
class RecordedSteps {
 public:
  /// Receives a message.  The payload is valid until the call returns.
  using Use = std::function<void(std::string_view channel, std::span<const std::byte> payload)>;

  /// `log` must outlive this and be a record (its time stamps are simulated time).
  explicit RecordedSteps(const ReplayLog& log);

  /// Passes on the inputs after `step` and before the next one.
  void inputs_after(std::int64_t step, const Use& use);
  /// Passes on the messages that the simulator published up to the end of `step`; steps must not decrease.
  void published_at(std::int64_t step, const Use& use);

 private:
  bool is_copy_of_input();

  const ReplayLog& log_;
  bridges::EventLogReader file_;
  bridges::LogEventView event_;
  bool has_event_ = false;  // event_ has not been passed on yet
  bool skipped_info_ = false;
  std::size_t next_input_ = 0, next_copy_ = 0;  // indices of inputs
};

/// Returns whether a message controls the run and does not belong to the world; programs do not receive these from a
/// record.
bool is_of_the_handshake(std::string_view channel);

}  // namespace experiment
