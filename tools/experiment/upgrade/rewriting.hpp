// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tools/experiment/upgrade/key_path.hpp"
#include "tools/experiment/upgrade/source_tree.hpp"
#include "tools/experiment/upgrade/text_edits.hpp"

namespace tools {

/// Lines that are written again are filled up to this many characters.
inline constexpr std::size_t max_line_length = 120;

/// A node that rewritings look at, after all nodes inside it.
struct Site {
  const SourceText& text;
  KeyPath path;
  const SourceNode& source;  ///< as it is written; never an alias
  sim::ConfigNode& meaning;  ///< what it is to mean from now on; a rewriting changes this ...
  TextEdits* edits;          ///< ... and the text.  Null: the text is not changed here, for it was or cannot be

  std::string source_of(TextSpan span) const { return text.text().substr(span.begin, span.end - span.begin); }
};

/// One kind of change from the format of an older version to that of this one.  Throws Doubt.
struct Rewriting {
  const char* what;
  void (*apply)(Site& site);
};

/// All of them, in the order in which they look at a node.  A new one is its own file and a line in
/// rewriting.cpp.
std::span<const Rewriting> rewritings();

// In the file of the same name each.
void rewrite_action(Site& site);
void rewrite_zero(Site& site);
void rewrite_rule(Site& site);
void rewrite_command(Site& site);
void rewrite_metric(Site& site);
void rewrite_names(Site& site);

}  // namespace tools
