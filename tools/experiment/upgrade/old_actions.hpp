// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "tools/experiment/upgrade/source_tree.hpp"

namespace tools {

/// An action of events as files of version 0.1 have it, `{publish: c, type: t}`: a map of which one key is its word.
struct OldAction {
  std::string_view word;
  std::string_view main_key;  ///< what the value of the word is called since version 0.2
};

std::span<const OldAction> old_actions();
/// Null when there is no action of this word.
const OldAction* find_old_action(std::string_view word);

/// The only key of a map that is the word of an action; null when there is none or more than one.
const SourceNode::Entry* word_of_action(const SourceNode& map);

}  // namespace tools
