// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace tools {

/// An action of events that files of version 0.1 have, `{publish: c, type: t}`: a map whose first key is its word.
struct OldAction {
  std::string_view word;
  std::string_view main_key;  ///< what the value of the word is called since version 0.2
};

std::span<const OldAction> old_actions();
/// Null when there is no action of this word.
const OldAction* find_old_action(std::string_view word);

}  // namespace tools
