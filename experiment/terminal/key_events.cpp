// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/key_events.hpp"

#include <charconv>
#include <string_view>

namespace experiment {

namespace {

constexpr char escape_byte = 27;

/// Name of a key by its code, a Unicode code point; empty: none.
std::string key_name(int code) {
  switch (code) {
    case ' ':
      return "space";
    case '\t':
      return "tab";
    case '\r':
    case '\n':
      return "enter";
    case 8:
    case 127:
      return "backspace";
    case escape_byte:
      return "escape";
    default:
      return code > ' ' && code < 127 ? std::string{static_cast<char>(code)} : std::string{};
  }
}

std::string arrow_name(char last) {
  switch (last) {
    case 'A':
      return "up";
    case 'B':
      return "down";
    case 'C':
      return "right";
    case 'D':
      return "left";
    default:
      return {};
  }
}

/// Number at the start of a text; 0: none.
int number_at(std::string_view text) {
  int value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::optional<KeyEvent> KeyEvents::sequence(const TerminalPiece& piece) {
  const std::string& parameters = piece.parameters;
  const char last = piece.byte;
  if (last == 'u' && parameters.starts_with('?')) has_reports_ = true;
  if (parameters.starts_with('?') || parameters == "[") return std::nullopt;  // "[": of the Linux console
  KeyEvent event;
  event.key = last == 'u' ? key_name(number_at(parameters)) : arrow_name(last);
  if (event.key.empty()) return std::nullopt;
  // Second parameter: 1 + modifiers, then the event.
  if (const std::size_t second = parameters.find(';'); second != std::string::npos) {
    const std::string_view rest = std::string_view(parameters).substr(second + 1);
    constexpr int ctrl = 4;
    event.ctrl = ((number_at(rest) - 1) & ctrl) != 0 && number_at(rest) > 0;
    if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
      const int action = number_at(rest.substr(colon + 1));
      if (action == 2) event.action = KeyEvent::Action::repeat;
      if (action == 3) event.action = KeyEvent::Action::release;
    }
  }
  return event;
}

std::optional<KeyEvent> KeyEvents::next(char byte) {
  const auto piece = parser_.next(byte);
  if (!piece || piece->kind == TerminalPiece::Kind::escape) return std::nullopt;
  if (piece->kind == TerminalPiece::Kind::sequence) return sequence(*piece);
  // Control characters are letters with Ctrl, except those that are keys.
  if (byte > 0 && byte <= 26 && key_name(byte).empty())
    return KeyEvent{std::string{static_cast<char>('a' + byte - 1)}, KeyEvent::Action::press, true};
  KeyEvent event{key_name(static_cast<unsigned char>(byte))};
  if (event.key.empty()) return std::nullopt;
  return event;
}

}  // namespace experiment
