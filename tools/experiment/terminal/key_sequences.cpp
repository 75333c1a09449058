// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/terminal/key_sequences.hpp"

namespace tools {

namespace {

constexpr char escape = 27;

}  // namespace

std::string KeySequences::next(char byte, Clock::time_point now) {
  const State before = state_;
  state_ = State::none;
  // ESC starts a sequence, or is a key.
  if (byte == escape) {
    state_ = State::started;
    begun_ = now;
    return before == State::started ? std::string{escape} : std::string{};
  }
  // Continue or end the sequence.
  switch (before) {
    case State::none:
      return {byte};
    case State::started:
      if (byte == '[') state_ = State::first_parameter;
      if (byte == 'O') state_ = State::one_more;
      return state_ == State::none ? std::string{escape, byte} : std::string{};
    case State::one_more:
      return {};
    case State::first_parameter:
      if (byte == '[') {
        state_ = State::one_more;
        return {};
      }
      [[fallthrough]];
    case State::parameters:
      if (byte >= ' ' && byte <= '?') state_ = State::parameters;
      return {};
  }
  return {};
}

std::string KeySequences::alone(Clock::time_point now) {
  if (state_ != State::started || now - begun_ < timeout) return {};
  state_ = State::none;
  return {escape};
}

}  // namespace tools
