// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace experiment {

/// Piece of what a terminal sends.
struct TerminalPiece {
  enum class Kind {
    character,  ///< one byte
    escaped,    ///< ESC and a byte: a character with Alt, or ESC and a character pressed quickly one after the other
    escape,     ///< ESC, which another ESC follows
    sequence    ///< of a key, such as an arrow
  };
  Kind kind = Kind::character;
  char byte = 0;           ///< the character, or the last one of a sequence
  std::string parameters;  ///< of a sequence: what is between its start and its last character
};

/// Separates the bytes of a terminal into characters and sequences: ESC [ or ESC O, parameters, and a letter or `~`
/// (ECMA-48, sections 5.4 and 8.3.16; ESC [ [ and a letter on the Linux console).
class TerminalParser {
 public:
  /// Returns the piece that a byte completes, if any.
  std::optional<TerminalPiece> next(char byte);
  /// Returns whether the last byte was an ESC of which it is not known yet whether it starts a sequence.
  bool is_at_escape() const { return state_ == State::escape; }
  /// Takes such an ESC as a key.
  void end_escape() { state_ = State::none; }

 private:
  enum class State { none, escape, first_parameter, parameters, last };
  State state_ = State::none;
  std::string parameters_;
};

/// Separates keys of one byte from keys that a terminal sends as several, such as arrows, Home and F1.  These are
/// discarded.
class KeySequences {
 public:
  using Clock = std::chrono::steady_clock;
  /// A single key is distinguished from the start of a sequence by a pause of this length.
  static constexpr std::chrono::milliseconds timeout{50};

  /// Returns the keys that the bytes of a terminal, passed one by one, represent.  None: this byte belongs to a
  /// sequence, or may belong to one.
  std::string next(char byte, Clock::time_point now);
  /// Returns ESC once it is certain that it was pressed alone.
  std::string alone(Clock::time_point now);

 private:
  TerminalParser parser_;
  Clock::time_point begun_{};
};

}  // namespace experiment
