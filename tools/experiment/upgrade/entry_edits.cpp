// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/entry_edits.hpp"

#include <algorithm>

namespace tools {

sim::ConfigNode::Entry& entry_of(sim::ConfigNode& map, std::string_view key) {
  return *std::find_if(map.entries.begin(), map.entries.end(), [&](const auto& entry) { return entry.key == key; });
}

std::string indentation_of(const Site& site, const SourceNode& map) {
  const std::size_t column = site.text.column(map.entries.front().key.start);
  const bool marked =
      site.text.line_begin(map.entries.front().key.start) == 0 && site.text.text().starts_with("\xef\xbb\xbf");
  return std::string(column - (marked ? 3 : 0), ' ');
}

void indent_lines(Site& site, TextSpan span, std::size_t spaces) {
  site.edits->indent_inserted_lines(site.source.span.begin, span.begin, spaces);
  const std::string& text = site.text.text();
  std::size_t line = site.text.line_begin(span.begin) == span.begin ? span.begin : site.text.line_end(span.begin);
  for (; line < span.end; line = site.text.line_end(line)) {
    const std::size_t first = text.find_first_not_of(" \t\r", line);
    if (first == std::string::npos || text[first] == '\n') continue;
    site.edits->insert(line, std::string(spaces, ' '));
  }
}

void replace_by_scalar(Site& site, const std::string& text) {
  sim::ConfigNode scalar = sim::scalar_node(text, site.meaning.place);
  site.meaning = std::move(scalar);
  if (site.edits == nullptr) return;
  if (site.source.pair) throw Doubt(site.source.start, "a pair without braces is not rewritten");
  TextSpan span = site.source.span;
  const std::string line_start = site.text.line_break() + std::string(site.text.column(span.begin), ' ');
  std::string written = text;
  bool has_comment = false;
  for (const TextSpan& comment : site.text.comments_in(span)) {
    const bool is_first_line = site.text.line_begin(comment.begin) <= span.begin;
    written += (is_first_line ? "  " : line_start) + site.source_of(comment);
    has_comment = true;
  }
  const std::string& whole = site.text.text();
  const std::size_t rest = std::min(whole.find_first_not_of(" \t\r", span.end), whole.size());
  if (has_comment && rest < whole.size() && whole[rest] != '\n') {
    written += line_start;
    span.end = rest;
  }
  site.edits->replace(span, written);
}

void insert_entry_after(Site& site, const SourceNode::Entry& entry, const std::string& key, const std::string& value) {
  const std::string name = entry.key.scalar;
  auto& entries = site.meaning.entries;
  const auto at = std::find_if(entries.begin(), entries.end(), [&](const auto& each) { return each.key == name; });
  entries.insert(std::next(at), {key, at->place, sim::scalar_node(value, at->place)});
  if (site.edits == nullptr) return;
  if (site.source.pair) throw Doubt(site.source.start, "a pair without braces is not rewritten");
  if (site.source.brackets) return site.edits->insert(entry.value.span.end, ", " + key + ": " + value);
  if (!entry.value.brackets && entry.value.kind != SourceNode::Kind::scalar)
    throw Doubt(entry.value.start, "no key can be added after this");
  const std::string& text = site.text.text();
  const std::string line_break = site.text.line_break();
  const std::string line = indentation_of(site, site.source) + key + ": " + value;
  const bool ends_its_line = entry.value.span.end > 0 && text[entry.value.span.end - 1] == '\n';  // a block scalar
  const std::size_t end = ends_its_line ? entry.value.span.end : site.text.line_end(entry.value.span.end);
  const bool has_break = end > 0 && text[end - 1] == '\n';
  site.edits->insert(end, has_break ? line + line_break : line_break + line);
}

}  // namespace tools
