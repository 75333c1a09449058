// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/terminal_parser.hpp"

#include <utility>

namespace experiment {
namespace {

constexpr char escape_of_terminal = 27;
constexpr std::size_t max_parameters = 64;  // bytes that are kept

}  // namespace

std::optional<TerminalPiece> TerminalParser::next(char byte) {
  const State before = std::exchange(state_, State::none);
  if (byte == escape_of_terminal) {
    state_ = State::escape;
    parameters_.clear();
    // The first of two escapes was the Escape key.
    if (before == State::escape) return TerminalPiece{TerminalPiece::Kind::escape, byte, {}};
    return std::nullopt;
  }
  switch (before) {
    case State::none:
      return TerminalPiece{TerminalPiece::Kind::character, byte, {}};
    case State::escape:
      if (byte == '[') state_ = State::first_parameter;
      // Keys in application mode (SS3) have one byte after ESC O.
      if (byte == 'O') state_ = State::last;
      if (state_ == State::none) return TerminalPiece{TerminalPiece::Kind::escaped, byte, {}};
      return std::nullopt;
    case State::first_parameter:
      // The Linux console sends ESC [ [ A for F1.
      if (byte == '[') {
        parameters_ += byte;
        state_ = State::last;
        return std::nullopt;
      }
      [[fallthrough]];
    case State::parameters:
      if (byte >= ' ' && byte <= '?') {
        if (parameters_.size() < max_parameters) parameters_ += byte;
        state_ = State::parameters;
        return std::nullopt;
      }
      break;
    case State::last:
      break;
  }
  return TerminalPiece{TerminalPiece::Kind::sequence, byte, std::exchange(parameters_, {})};
}

namespace {

constexpr char escape_key = 27;

}  // namespace

std::string KeySequences::next(char byte, Clock::time_point now) {
  const auto piece = parser_.next(byte);
  // The Escape key and the start of a sequence are distinguished by the time until the next byte.
  if (parser_.is_at_escape()) begun_ = now;
  if (!piece) return {};
  switch (piece->kind) {
    case TerminalPiece::Kind::character:
      return {piece->byte};
    case TerminalPiece::Kind::escaped:
      return {escape_key, piece->byte};
    case TerminalPiece::Kind::escape:
      return {escape_key};
    case TerminalPiece::Kind::sequence:
      break;
  }
  return {};
}

std::string KeySequences::alone(Clock::time_point now) {
  if (!parser_.is_at_escape() || now - begun_ < timeout) return {};
  parser_.end_escape();
  return {escape_key};
}

}  // namespace experiment
