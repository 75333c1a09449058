// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/key_sequences.hpp"

namespace experiment {

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
