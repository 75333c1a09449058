// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/experiment/upgrade/rewriting.hpp"

namespace tools {

/// Adds `key: value` to the map of the site, after one of its entries; `value` is a plain word.
void insert_entry_after(Site& site, const SourceNode::Entry& entry, const std::string& key, const std::string& value);

/// The entry of this key in a map.  It must be there.
sim::ConfigNode::Entry& entry_of(sim::ConfigNode& map, std::string_view key);

/// Spaces before the keys of a block map.
std::string indentation_of(const Site& site, const SourceNode& map);

/// Writes a plain scalar where the node of the site is.  Comments inside the node stay, after the scalar.
void replace_by_scalar(Site& site, const std::string& text);

/// Moves every line that begins in `span` to the right, but empty ones, and those that were inserted there.
void indent_lines(Site& site, TextSpan span, std::size_t spaces);

}  // namespace tools
