// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/entry_edits.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

// Up to version 0.1 a metric without a type was a position error.

namespace tools {

void rewrite_metric(Site& site) {
  if (!site.path.is(FileKind::world, "metrics.*") || site.source.kind != SourceNode::Kind::map) return;
  const SourceNode::Entry* name = site.source.find("name");
  // Otherwise a file that this one includes, or that includes this one, may set the type.
  const bool has_layers = site.text.root().find("include") != nullptr;
  const bool is_whole = !has_layers && site.source.find("channel") != nullptr && site.source.find("vehicle") != nullptr;
  if (name == nullptr || site.source.find("type") != nullptr || !is_whole) return;
  insert_entry_after(site, *name, "type", "position_error");
}

}  // namespace tools
