// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tools/experiment/upgrade/key_path.hpp"
#include "tools/experiment/upgrade/source_tree.hpp"
#include "tools/experiment/upgrade/text_edits.hpp"

namespace tools {

/// Rewritten lines are filled up to this number of characters.
inline constexpr std::size_t max_line_length = 120;

/// Node to be rewritten, after all nodes inside it.
struct Site {
  const SourceText& text;
  KeyPath path;
  const SourceNode& source;  ///< node as written in the file; never an alias
  sim::ConfigNode& meaning;  ///< meaning after the upgrade; changed by a rewriting together with ...
  TextEdits* edits;          ///< ... the text.  Null: the text is not changed here, because it was changed before or
                             ///< cannot be

  std::string source_of(TextSpan span) const { return text.text().substr(span.begin, span.end - span.begin); }
};

/// Change from the format of an older version to that of this one.  Throws Doubt.
struct Rewriting {
  const char* what;
  void (*apply)(Site& site);
};

/// Returns all rewritings, in the order in which they are applied to a node.  A new one has its own file and a line in
/// rewriting.cpp.
std::span<const Rewriting> rewritings();

// Each of these is in the file of the same name.
void rewrite_action(Site& site);
void rewrite_zero(Site& site);
void rewrite_rule(Site& site);
void rewrite_command(Site& site);
void rewrite_metric(Site& site);
void rewrite_names(Site& site);

}  // namespace tools
