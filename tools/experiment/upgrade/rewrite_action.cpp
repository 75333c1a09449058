// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "tools/experiment/upgrade/entry_edits.hpp"
#include "tools/experiment/upgrade/old_actions.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

// Since version 0.2 an action is a map of one key, its word: `publish: {channel: c, type: t}`.  Before, its word was
// the first of its keys: `{publish: c, type: t}`.

namespace tools {

namespace {

using Kind = SourceNode::Kind;

constexpr std::size_t indentation_step = 2;
constexpr std::size_t line_width = 120;

/// `{one_of: [a, b]}` in place of a name has the key of the action already.
bool has_own_key(const SourceNode& value, std::string_view word) {
  return (word == "move" || word == "remove") && value.kind == Kind::map && value.entries.size() == 1 &&
         value.entries.front().key.scalar == "one_of";
}

/// Whether the map is an action of version 0.1 with more than the value of its word.
bool is_old(const SourceNode& map, const OldAction& action) {
  if (map.entries.size() > 1) return true;
  // `add: {name: b, parts: [...]}`
  const SourceNode& value = *map.entries.front().value.target;
  return action.word == "add" && value.kind == Kind::map && value.find("object") == nullptr &&
         value.find("name") != nullptr;
}

/// Where a line would be too long, the last key begins a new one.
void break_line(Site& site, std::size_t added, std::size_t column) {
  const SourceNode::Entry& last = site.source.entries.back();
  const std::size_t begin = site.text.line_begin(last.key.start);
  const std::size_t length = site.text.line_end(last.key.start) - begin;
  const std::size_t after_comma = site.text.text().find_last_not_of(' ', last.key.start - 1) + 1;
  const bool is_on_line = begin == site.text.line_begin(site.source.span.begin);
  if (!is_on_line || length > line_width + 1 || length + added <= line_width + 1) return;
  site.edits->replace({after_comma, last.key.start}, site.text.line_break() + std::string(column, ' '));
}

/// `{publish: c, type: t}` becomes `{publish: {channel: c, type: t}}`.
void nest_in_brackets(Site& site, const std::string& main_key) {
  const SourceNode::Entry& first = site.source.entries.front();
  const TextSpan value = first.value.span;
  const std::size_t before_brace = site.source.span.end - 1;
  if (main_key.empty()) {
    if (!first.value.brackets || first.value.properties)
      throw Doubt(first.value.start, "the keys of this map are not moved");
    site.edits->erase({value.end - 1, value.end});
  } else if (first.value.kind == Kind::null && value.begin == value.end) {
    site.edits->insert(first.after_colon, " {" + main_key + ":");
  } else {
    site.edits->insert(first.value.start, "{" + main_key + ": ");
    if (site.source.entries.size() > 1) break_line(site, main_key.size() + 4, site.text.column(first.value.start) + 1);
  }
  site.edits->insert(before_brace, "}");
}

/// The keys after the first one, and the value of the first where it begins on a line of its own, move to the right.
void nest_in_block(Site& site, const std::string& main_key) {
  const SourceNode::Entry& first = site.source.entries.front();
  const SourceNode& value = first.value;
  const std::string indentation = indentation_of(site, site.source);
  const std::string new_line = site.text.line_break() + indentation + std::string(indentation_step, ' ');
  const std::size_t next_line = site.text.line_end(first.key.start);
  const bool is_on_line_of_key = value.start < next_line && value.span.end > value.span.begin;
  const TextSpan moved{is_on_line_of_key ? value.start : next_line, site.source.span.end};
  if (!main_key.empty()) {
    indent_lines(site, moved, indentation_step);
    const TextSpan gap{first.after_colon, is_on_line_of_key ? value.start : first.after_colon};
    site.edits->replace(gap, new_line + main_key + (is_on_line_of_key ? ": " : ":"));
  } else if (value.brackets && is_on_line_of_key && !value.properties) {
    indent_lines(site, moved, indentation_step);
    site.edits->replace({first.after_colon, value.span.begin + 1}, new_line);
    site.edits->erase({value.span.end - 1, value.span.end});
  } else if (!value.brackets && !is_on_line_of_key && !value.properties) {
    const std::size_t shift = site.text.column(value.start) - indentation.size();
    indent_lines(site, {site.text.line_end(value.span.end), site.source.span.end}, shift);
  } else {
    throw Doubt(value.start, "the keys of this map are not moved");
  }
}

}  // namespace

void rewrite_action(Site& site) {
  if (!site.path.is_action() || site.source.kind != Kind::map || site.source.entries.empty()) return;
  const std::string word = site.source.entries.front().key.scalar;
  const OldAction* action = find_old_action(word);
  if (action == nullptr || !is_old(site.source, *action)) return;
  const SourceNode& value = *site.source.entries.front().value.target;
  const bool own_key = has_own_key(value, word);
  if (own_key && site.source.entries.size() == 1) return;
  if (own_key && site.source.entries.front().value.kind == Kind::alias)
    throw Doubt(site.source.entries.front().value.start, "the keys of an alias are not moved");
  const std::string main_key = own_key ? "" : std::string(action->main_key);

  sim::ConfigNode keys;
  keys.kind = sim::ConfigNode::Kind::map;
  keys.place = site.meaning.place;
  for (sim::ConfigNode::Entry& entry : site.meaning.entries) {
    if (&entry != &site.meaning.entries.front()) {
      keys.entries.push_back(std::move(entry));
    } else if (own_key) {
      keys.entries = std::move(entry.value.entries);
    } else {
      keys.entries.push_back({main_key, entry.place, std::move(entry.value)});
    }
  }
  const sim::SourcePlace place = site.meaning.entries.front().place;
  site.meaning.entries.clear();
  site.meaning.entries.push_back({word, place, std::move(keys)});

  if (site.edits == nullptr) return;
  if (site.source.pair) throw Doubt(site.source.start, "a pair without braces is not rewritten");
  if (site.source.brackets)
    nest_in_brackets(site, main_key);
  else
    nest_in_block(site, main_key);
}

}  // namespace tools
