// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "experiment/terminal/terminal_parser.hpp"

namespace experiment {

/// Event of a key.
struct KeyEvent {
  enum class Action { press, repeat, release };
  std::string key;  ///< character, or space, tab, enter, backspace, escape, up, down, left, right
  Action action = Action::press;
  bool ctrl = false;
};

/// Separates the bytes of a terminal into events of keys: characters, arrows (ESC [ A or ESC O A, ECMA-48), and the
/// reports of the Kitty keyboard protocol, ESC [ CODE ; MODIFIERS : EVENT u, with releases.  Other keys have no event.
class KeyEvents {
 public:
  /// Asks the terminal whether it has the Kitty keyboard protocol; such a one answers ESC [ ? FLAGS u.
  static constexpr const char* query = "\x1b[?u";
  /// Requests releases, and reports instead of characters: flags 1 (no ambiguous codes), 2 (events), 8 (all keys).
  static constexpr const char* start_reports = "\x1b[>11u";
  /// Restores what was before start_reports.
  static constexpr const char* end_reports = "\x1b[<u";

  /// Returns the event that a byte completes, if any.
  std::optional<KeyEvent> next(char byte);
  /// Returns whether the terminal has answered the query.
  bool has_reports() const { return has_reports_; }

 private:
  std::optional<KeyEvent> sequence(const TerminalPiece& piece);

  TerminalParser parser_;
  bool has_reports_ = false;
};

}  // namespace experiment
