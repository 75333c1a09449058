// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_terms.hpp"

#include <utility>

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

std::string text_of(const sim::LockstepTerms& terms) {
  std::string text = "{session: " + std::to_string(terms.session) + ", receives: [";
  const char* between = "";
  for (const std::string& channel : terms.receives) text += std::exchange(between, ", ") + quoted(channel);
  text += "]";
  if (!terms.on_timeout.empty()) text += ", on_timeout: " + quoted(terms.on_timeout);
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
