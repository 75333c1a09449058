// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_terms.hpp"

#include <utility>

#include "bridges/base/bus_error.hpp"
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
  if (terms.timeout_s != 0) text += ", timeout_s: " + std::to_string(terms.timeout_s);
  return text + "}";
}

std::string text_of(const sim::LeaveTerms& terms) {
  return "{session: " + std::to_string(terms.session) + ", acknowledged: " + std::to_string(terms.acknowledged) + "}";
}

std::string text_of(const sim::FollowTerms& terms) {
  return "{session: " + std::to_string(terms.session) + "}";
}

}  // namespace bridges
