// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/upgrade/source_tree.hpp"

namespace tools {

/// Lines of a text before and after a change, without their line breaks.
struct ChangedLines {
  int first_line = 1;  ///< in the old text
  std::vector<std::string> before, after;
};

/// Changes of a text, located by bytes of the original text.
class TextEdits {
 public:
  void insert(std::size_t at, std::string text) { replace({at, at}, std::move(text)); }
  void erase(TextSpan span) { replace(span, ""); }
  void replace(TextSpan span, std::string text) { edits_.push_back({span, std::move(text)}); }
  /// Indents the lines that were inserted from byte `begin` on, like the lines around them.  Text after the node that
  /// starts at `node` must not have been changed yet.
  void indent_inserted_lines(std::size_t node, std::size_t begin, std::size_t spaces);
  bool empty() const { return edits_.empty(); }

  /// Returns the changed text.  Throws Doubt where a change is inside text that another one replaces.
  std::string applied_to(const std::string& text) const;
  /// Returns the lines that changed, from top to bottom.
  std::vector<ChangedLines> changed_lines(const SourceText& text) const;

 private:
  struct Edit {
    TextSpan span;
    std::string text;
  };

  std::vector<Edit> sorted() const;

  std::vector<Edit> edits_;
};

}  // namespace tools
