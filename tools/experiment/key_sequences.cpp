#include "tools/experiment/key_sequences.hpp"

namespace tools {

namespace {

constexpr char escape = 27;

}  // namespace

std::optional<char> KeySequences::next(char byte, Clock::time_point now) {
  const State before = state_;
  state_ = State::none;
  if (byte == escape) {
    state_ = State::begun;
    begun_ = now;
    return std::nullopt;
  }
  switch (before) {
    case State::none:
      return byte;
    case State::begun:
      if (byte == '[') state_ = State::first_parameter;
      if (byte == 'O') state_ = State::one_more;
      return std::nullopt;  // else Alt and a key, which mean nothing either
    case State::one_more:
      return std::nullopt;
    case State::first_parameter:
      if (byte == '[') {
        state_ = State::one_more;
        return std::nullopt;
      }
      [[fallthrough]];
    case State::parameters:
      if (byte >= ' ' && byte <= '?') state_ = State::parameters;
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<char> KeySequences::alone(Clock::time_point now) {
  if (state_ != State::begun || now - begun_ < patience) return std::nullopt;
  state_ = State::none;
  return escape;
}

}  // namespace tools
