// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "sim/script/action_registry.hpp"

namespace sim {

/// Returns whether all keys of a map belong to the action, and none is duplicate.
bool has_keys_of(const ConfigNode& value, const ActionKind& kind);

/// Converts an action from the form before version 0.2, `{publish: c, type: t}`, with the keys of the action beside its
/// word, to the present form `{publish: {channel: c, type: t}}`.
ConfigNode new_form_of(const ConfigNode& action, const ActionKind& kind);

/// Returns a map on one line and without its braces, for error messages: `publish: {channel: c, value: {...}}`.  Values
/// are cut when the line would be longer than about `limit`.
std::string brief_text(const ConfigNode& map, std::size_t limit = 100);

}  // namespace sim
