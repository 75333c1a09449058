// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/upgrade/source_tree.hpp"

namespace tools {

/// Lines of a text as they were and as they are to be, without their line breaks.
struct ChangedLines {
  int first_line = 1;  ///< in the old text
  std::vector<std::string> before, after;
};

/// Changes of a text, each at bytes of the text as it was.
class TextEdits {
 public:
  void insert(std::size_t at, std::string text) { replace({at, at}, std::move(text)); }
  void erase(TextSpan span) { replace(span, ""); }
  void replace(TextSpan span, std::string text) { edits_.push_back({span, std::move(text)}); }
  /// Moves the lines that were inserted from byte `begin` on to the right, as the lines around them are.  Nothing
  /// behind the node that begins at `node` may have been changed yet.
  void indent_inserted_lines(std::size_t node, std::size_t begin, std::size_t spaces);
  bool empty() const { return edits_.empty(); }

  /// The changed text.  Throws Doubt where a change is inside what another one replaces.
  std::string applied_to(const std::string& text) const;
  /// The lines that are not as they were, from top to bottom.
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
