// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/text_edits.hpp"

#include <algorithm>

namespace tools {

namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.emplace_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

}  // namespace

void TextEdits::indent_inserted_lines(std::size_t node, std::size_t begin, std::size_t spaces) {
  // The last changes are those inside the node.
  for (auto last = edits_.rbegin(); last != edits_.rend() && last->span.begin >= node; ++last) {
    if (last->span.begin < begin) continue;
    Edit& edit = *last;
    for (std::size_t at = edit.text.find('\n'); at != std::string::npos; at = edit.text.find('\n', at + 1))
      if (at + 1 < edit.text.size() && edit.text[at + 1] == ' ') edit.text.insert(at + 1, spaces, ' ');
  }
}

std::vector<TextEdits::Edit> TextEdits::sorted() const {
  std::vector<Edit> sorted = edits_;
  // An insertion at the start of a replaced span precedes the replacement.
  std::stable_sort(sorted.begin(), sorted.end(), [](const Edit& a, const Edit& b) {
    return a.span.begin != b.span.begin ? a.span.begin < b.span.begin : a.span.end < b.span.end;
  });
  return sorted;
}

std::string TextEdits::applied_to(const std::string& text) const {
  std::string changed;
  std::size_t done = 0;
  for (const Edit& edit : sorted()) {
    if (edit.span.begin < done) throw Doubt(edit.span.begin, "two changes of this text overlap");
    changed.append(text, done, edit.span.begin - done).append(edit.text);
    done = edit.span.end;
  }
  return changed.append(text, done);
}

std::vector<ChangedLines> TextEdits::changed_lines(const SourceText& source) const {
  struct Block {
    TextSpan lines;
    TextEdits edits;
  };
  // Group edits that share lines.
  std::vector<Block> blocks;
  for (const Edit& edit : sorted()) {
    const TextSpan lines{source.line_begin(edit.span.begin),
                         source.line_end(std::max(edit.span.begin, edit.span.end - (edit.span.end > edit.span.begin)))};
    if (blocks.empty() || blocks.back().lines.end <= lines.begin) blocks.push_back({lines, {}});
    Block& block = blocks.back();
    block.lines.end = std::max(block.lines.end, lines.end);
    block.edits.replace({edit.span.begin - block.lines.begin, edit.span.end - block.lines.begin}, edit.text);
  }
  // Apply the edits of each group to its lines.
  std::vector<ChangedLines> changes;
  std::size_t counted = 0;
  int line = 1;
  for (const Block& block : blocks) {
    const std::string& text = source.text();
    line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(counted),
                                        text.begin() + static_cast<std::ptrdiff_t>(block.lines.begin), '\n'));
    counted = block.lines.begin;
    const std::string before = text.substr(block.lines.begin, block.lines.end - block.lines.begin);
    changes.push_back({line, lines_of(before), lines_of(block.edits.applied_to(before))});
  }
  return changes;
}

}  // namespace tools
