// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/experiment/upgrade/rewriting.hpp"

namespace tools {

/// Adds `key: value` to the map of the site, after one of its entries; `value` is a plain word.
void insert_entry_after(Site& site, const SourceNode::Entry& entry, const std::string& key, const std::string& value);

/// Returns the entry of this key in a map.  It must exist.
sim::ConfigNode::Entry& entry_of(sim::ConfigNode& map, std::string_view key);

/// Returns the number of spaces before the keys of a block map.
std::string indentation_of(const Site& site, const SourceNode& map);

/// Replaces the node of the site by a plain scalar.  Comments inside the node are kept, after the scalar.
void replace_by_scalar(Site& site, const std::string& text);

/// Indents every line that starts in `span`, except empty and inserted ones.
void indent_lines(Site& site, TextSpan span, std::size_t spaces);

}  // namespace tools
