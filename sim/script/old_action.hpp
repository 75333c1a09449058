// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "sim/script/action_registry.hpp"

namespace sim {

/// Whether each key of a map is one of the action's, and none is there twice.
bool has_keys_of(const ConfigNode& value, const ActionKind& kind);

/// The action as files have it since version 0.2, `{publish: {channel: c, type: t}}`, of one as they had it before:
/// `{publish: c, type: t}`, a map with the keys of the action beside its word.
ConfigNode new_form_of(const ConfigNode& action, const ActionKind& kind);

/// A map on one line and without its braces, for error messages: `publish: {channel: c, value: {...}}`.  Values are
/// cut when the line would be longer than about `limit`.
std::string brief_text(const ConfigNode& map, std::size_t limit = 100);

}  // namespace sim
