// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "tools/experiment/upgrade/source_tree.hpp"

namespace tools {

/// Action of an event in the form of version 0.1, `{publish: c, type: t}`: a map with one key that names the action.
struct OldAction {
  std::string_view word;
  std::string_view main_key;  ///< key of that word's value since version 0.2
};

std::span<const OldAction> old_actions();
/// Returns null when there is no action with this word.
const OldAction* find_old_action(std::string_view word);

/// Returns the only key of a map that is the word of an action; null when there is none or more than one.
const SourceNode::Entry* word_of_action(const SourceNode& map);

}  // namespace tools
