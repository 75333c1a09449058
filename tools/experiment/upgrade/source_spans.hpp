// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/upgrade/source_tree.hpp"

namespace tools {

/// Sets `span` and `after_colon` of every node below `root`, from the text and the start of each node. Returns the
/// comments in their order.  Every byte between the nodes must be white space, a comment or a valid indicator, and
/// every scalar must be written as its value; throws Doubt where this is not the case, and for explicit keys (`? key`)
/// and block scalars with an indentation indicator.
std::vector<TextSpan> find_spans(const std::string& text, SourceNode& root);

}  // namespace tools
