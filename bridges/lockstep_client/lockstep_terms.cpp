// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_terms.hpp"

#include <algorithm>
#include <utility>

#include "bridges/base/bus_error.hpp"
#include "sim/base/number.hpp"

namespace bridges {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Returns at most 300 bytes of a text, with spaces in place of control characters.
std::string one_line(const std::string& text) {
  constexpr std::size_t max_length = 300;
  const auto within_character = [&](std::size_t at) { return at < text.size() && (text[at] & 0xc0) == 0x80; };
  std::size_t length = std::min(text.size(), max_length);
  while (length > 0 && within_character(length)) --length;
  std::string line = text.substr(0, length);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  return line;
}

}  // namespace

std::optional<sim::OnTimeout> on_timeout_of(const std::string& word) {
  if (word.empty()) return std::nullopt;
  if (const auto value = value_of(sim::on_timeout_words, word)) return value;
  std::string known;
  for (const auto& each : sim::on_timeout_words) known += (known.empty() ? "" : ", ") + std::string(each.word);
  throw BusError("'on_timeout' must be one of: " + known + "; got '" + word + "'");
}

std::string text_of(const sim::LockstepTerms& terms) {
  std::string text = "{session: " + std::to_string(terms.session) + ", receives: [";
  const char* between = "";
  for (const std::string& channel : terms.receives) text += std::exchange(between, ", ") + quoted(channel);
  text += "]";
  if (terms.agreed) text += ", on_timeout: " + std::string(word_of(sim::on_timeout_words, terms.on_timeout));
  if (terms.timeout_s != 0) text += ", timeout_s: " + sim::shortest_text(terms.timeout_s);
  return text + "}";
}

std::string text_of(const sim::LeaveTerms& terms) {
  std::string text =
      "{session: " + std::to_string(terms.session) + ", acknowledged: " + std::to_string(terms.acknowledged);
  if (!terms.reason.empty()) text += ", reason: " + quoted(one_line(terms.reason));
  return text + "}";
}

std::string text_of(const sim::FollowTerms& terms) {
  return "{session: " + std::to_string(terms.session) + "}";
}

}  // namespace bridges
