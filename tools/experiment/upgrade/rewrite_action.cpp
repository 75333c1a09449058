// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/entry_edits.hpp"
#include "tools/experiment/upgrade/old_actions.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

// Since version 0.2 an action is a map of one key, its word: `publish: {channel: c, type: t}`.  Before, its word was
// one of its keys: `{publish: c, type: t}`.

namespace tools {

namespace {

using Kind = SourceNode::Kind;

constexpr std::size_t indentation_step = 2;

/// Rewrites an action of version 0.1.
class ActionRewriting {
 public:
  ActionRewriting(Site& site, const SourceNode::Entry& word, const OldAction& action)
      : site_(site), map_(site.source), word_(word), action_(action) {}

  bool is_old() const {
    if (map_.entries.size() > 1) return true;
    // `add: {name: b, parts: [...]}`
    const SourceNode& value = *word_.value.target;
    return action_.word == "add" && value.kind == Kind::map && value.find("object") == nullptr &&
           value.find("name") != nullptr;
  }

  void apply() {
    change_meaning();
    if (site_.edits == nullptr) return;
    if (map_.pair) throw Doubt(map_.start, "a pair without braces is not rewritten");
    if (map_.brackets)
      nest_in_braces();
    else
      nest_in_block();
  }

 private:
  /// Handles `{one_of: [a, b]}` in place of a name: its key is one of the action.
  bool has_own_key() const {
    const SourceNode& value = *word_.value.target;
    return (action_.word == "move" || action_.word == "remove") && value.kind == Kind::map &&
           value.entries.size() == 1 && value.entries.front().key.scalar == "one_of";
  }

  void change_meaning() {
    sim::ConfigNode keys;
    keys.kind = sim::ConfigNode::Kind::map;
    keys.place = site_.meaning.place;
    for (sim::ConfigNode::Entry& entry : site_.meaning.entries) {
      if (entry.key != action_.word)
        keys.entries.push_back(std::move(entry));
      else if (has_own_key())
        keys.entries.push_back(std::move(entry.value.entries.front()));
      else
        keys.entries.push_back({std::string(action_.main_key), entry.place, std::move(entry.value)});
    }
    const sim::SourcePlace place = keys.place;
    site_.meaning.entries.clear();
    site_.meaning.entries.push_back({std::string(action_.word), place, std::move(keys)});
  }

  /// Rewrites `{publish: c, type: t}` as `{publish: {channel: c, type: t}}`.
  void nest_in_braces() {
    site_.edits->insert(map_.entries.front().key.start, std::string(action_.word) + ": {");
    rename_word();
    if (map_.entries.size() > 1) break_line();
    site_.edits->insert(map_.span.end - 1, "}");
  }

  /// Breaks the line before the last key where it would be too long.
  void break_line() {
    const SourceNode::Entry& last = map_.entries.back();
    const std::size_t begin = site_.text.line_begin(map_.span.begin);
    const std::size_t length = site_.text.line_end(last.key.start) - begin;
    const std::size_t added = action_.main_key.size() + std::string_view(": {}").size();
    const bool was_short = length <= max_line_length + 1;  // with the line break
    if (begin != site_.text.line_begin(last.key.start) || !was_short || length + added <= max_line_length + 1) return;
    const std::size_t after_comma = site_.text.text().find_last_not_of(' ', last.key.start - 1) + 1;
    const std::size_t column =
        site_.text.column(map_.span.begin) + action_.word.size() + std::string_view("{: {").size();
    site_.edits->replace({after_comma, last.key.start}, site_.text.line_break() + std::string(column, ' '));
  }

  /// Puts the word on its own line and indents the keys.
  void nest_in_block() {
    const SourceNode::Entry& first = map_.entries.front();
    const std::string indentation = indentation_of(site_, map_);
    if (has_own_key() && !word_.value.brackets) return join_own_key(indentation.size());
    indent_lines(site_, {first.key.span.end, map_.span.end}, indentation_step);
    site_.edits->insert(first.key.start, std::string(action_.word) + ":" + site_.text.line_break() + indentation +
                                             std::string(indentation_step, ' '));
    rename_word();
  }

  /// Keeps the key below the word, which is in the right place, and moves the others to it.
  void join_own_key(std::size_t column) {
    const bool is_below = word_.value.start >= site_.text.line_end(word_.key.start);
    const bool is_plain = !word_.value.properties && word_.value.kind != Kind::alias;
    if (&word_ != &map_.entries.front() || !is_below || !is_plain)
      throw Doubt(word_.value.start, "the keys of this map are not moved");
    const std::size_t shift = site_.text.column(word_.value.start) - column;
    indent_lines(site_, {site_.text.line_end(word_.value.span.end), map_.span.end}, shift);
  }

  /// Converts the key that was the word to the main key; `move: {one_of: [a, b]}` is `one_of: [a, b]`.
  void rename_word() {
    const SourceNode& value = word_.value;
    if (has_own_key()) {
      if (!value.brackets || value.properties) throw Doubt(value.start, "the keys of this map are not moved");
      site_.edits->erase({word_.key.span.begin, value.span.begin + 1});
      site_.edits->erase({value.span.end - 1, value.span.end});
      return;
    }
    const std::string& text = site_.text.text();
    const std::size_t next = word_.after_colon;
    const bool has_space = next == text.size() || std::string_view(" \t\r\n").find(text[next]) != std::string::npos;
    site_.edits->replace({word_.key.span.begin, next}, std::string(action_.main_key) + (has_space ? ":" : ": "));
  }

  Site& site_;
  const SourceNode& map_;
  const SourceNode::Entry& word_;
  const OldAction& action_;
};

}  // namespace

void rewrite_action(Site& site) {
  if (!site.path.is_action() || site.source.kind != Kind::map) return;
  const SourceNode::Entry* word = word_of_action(site.source);
  if (word == nullptr) return;
  ActionRewriting rewriting(site, *word, *find_old_action(word->key.scalar));
  if (rewriting.is_old()) rewriting.apply();
}

}  // namespace tools
