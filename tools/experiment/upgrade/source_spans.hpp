// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/upgrade/source_tree.hpp"

namespace tools {

/// Fills in `span` of every node below `root`, and `after_colon`, from the text and from where each node begins.
/// Returns the comments in their order.  Every byte between the nodes must be white space, a comment or an indicator
/// that belongs there, and every scalar must be written as its value says; throws Doubt where that does not hold, and
/// at explicit keys (`? key`) and block scalars with an indentation indicator.
std::vector<TextSpan> find_spans(const std::string& text, SourceNode& root);

}  // namespace tools
