// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/source_spans.hpp"

#include <algorithm>
#include <string_view>

namespace tools {

namespace {

using Kind = SourceNode::Kind;

constexpr std::string_view flow_indicators = ",[]{}";
constexpr const char* not_followed = "this form of YAML is not followed by 'shoal upgrade'";

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

bool is_space(char c) {
  return is_blank(c) || c == '\n' || c == '\r';
}

/// Scanner of the text from node to node.  `cursor_` is the first byte that is not accounted for yet.
class SpanFinder {
 public:
  explicit SpanFinder(const std::string& text) : text_(text) {
    if (text.starts_with("\xef\xbb\xbf")) cursor_ = 3;
  }

  std::vector<TextSpan> find(SourceNode& root) {
    skip_document_start();
    const bool is_empty = root.kind == Kind::null && !is_null_word(root.start);
    if (!is_empty) {
      skip_to(root.start);
      place(root, false);
    }
    skip_space();
    if (text_.compare(cursor_, 3, "...") == 0) cursor_ += 3;
    skip_space();
    if (cursor_ != text_.size()) stop(not_followed);
    return std::move(comments_);
  }

 private:
  [[noreturn]] void stop(const char* why) const { throw Doubt(cursor_, why); }

  char at(std::size_t i) const { return i < text_.size() ? text_[i] : '\n'; }

  /// Skips directives and `---`.
  void skip_document_start() {
    skip_space();
    while (at(cursor_) == '%' && cursor_ < text_.size()) {
      cursor_ = std::min(text_.find('\n', cursor_), text_.size());
      skip_space();
    }
    const bool marker = text_.compare(cursor_, 3, "---") == 0 && is_space(at(cursor_ + 3));
    if (marker) cursor_ += 3;
  }

  /// Skips white space and comments.
  void skip_space() {
    while (cursor_ < text_.size()) {
      if (text_[cursor_] == '#' && (cursor_ == 0 || is_space(text_[cursor_ - 1]) || text_[cursor_ - 1] == '\xbf'))
        skip_comment();
      else if (is_space(text_[cursor_]))
        ++cursor_;
      else
        return;
    }
  }

  void skip_comment() {
    const std::size_t begin = cursor_;
    cursor_ = std::min(text_.find('\n', cursor_), text_.size());
    std::size_t end = cursor_;
    while (end > begin && is_space(text_[end - 1])) --end;
    comments_.push_back({begin, end});
  }

  /// Skips white space, comments and `indicator`s up to `to`.
  void skip_to(std::size_t to, char indicator = ' ') {
    for (skip_space(); cursor_ < to && text_[cursor_] == indicator; skip_space()) ++cursor_;
    if (cursor_ != to) stop(not_followed);
  }

  /// Skips white space, comments and commas up to the bracket, and the bracket.
  void skip_bracket(char bracket) {
    for (skip_space(); at(cursor_) == ',' && cursor_ < text_.size(); skip_space()) ++cursor_;
    if (at(cursor_) != bracket) stop(not_followed);
    ++cursor_;
  }

  /// Returns the length of a complete word for null.
  std::size_t null_word_length(std::size_t from) const {
    for (const std::string_view word : {"~", "null", "Null", "NULL"})
      if (text_.compare(from, word.size(), word) == 0) {
        const char next = at(from + word.size());
        if (is_space(next) || flow_indicators.find(next) != std::string_view::npos) return word.size();
      }
    return 0;
  }
  bool is_null_word(std::size_t from) const { return from < text_.size() && null_word_length(from) > 0; }

  /// Returns the first byte after blanks.
  std::size_t after_blanks(std::size_t from) const {
    while (from < text_.size() && is_blank(text_[from])) ++from;
    return from;
  }

  /// Sets the span of a value.  The mark of an empty one is that of the following token.
  void place_value(SourceNode& value, bool in_brackets) {
    if (value.kind == Kind::null) {
      const std::size_t from = after_blanks(cursor_);
      const bool is_written = from == value.start && (is_null_word(from) || at(from) == '&' || at(from) == '!');
      if (!is_written) {
        value.start = cursor_;
        value.span = {cursor_, cursor_};
        return;
      }
    }
    skip_to(value.start);
    place(value, in_brackets);
  }

  void place(SourceNode& node, bool in_brackets) {
    skip_properties(node, in_brackets);
    node.span.begin = cursor_;
    switch (node.kind) {
      case Kind::null:
        cursor_ += null_word_length(cursor_);
        break;
      case Kind::alias:
        place_alias();
        break;
      case Kind::scalar:
        place_scalar(node, in_brackets);
        break;
      case Kind::list:
        place_list(node, in_brackets);
        break;
      case Kind::map:
        place_map(node, in_brackets);
        break;
    }
    node.span.end = cursor_;
  }

  bool ends_property(char c, bool in_brackets) const {
    return is_space(c) || (in_brackets && flow_indicators.find(c) != std::string_view::npos);
  }

  /// Skips tags and anchors.
  void skip_properties(SourceNode& node, bool in_brackets) {
    while (at(cursor_) == '&' || at(cursor_) == '!') {
      node.properties = true;
      while (!ends_property(at(cursor_), in_brackets)) ++cursor_;
      if (node.kind == Kind::null || (node.kind == Kind::scalar && node.scalar.empty()))
        cursor_ = is_null_word(after_blanks(cursor_)) ? after_blanks(cursor_) : cursor_;
      else
        skip_space();
      if (node.kind == Kind::scalar && node.scalar.empty()) {
        const std::size_t next = after_blanks(cursor_);
        if (at(next) == '"' || at(next) == '\'') cursor_ = next;
      }
    }
  }

  void place_alias() {
    if (at(cursor_) != '*') stop(not_followed);
    while (cursor_ < text_.size() && !is_space(text_[cursor_]) &&
           flow_indicators.find(text_[cursor_]) == std::string_view::npos)
      ++cursor_;
  }

  void place_scalar(const SourceNode& node, bool in_brackets) {
    const char first = at(cursor_);
    if (first == '"' || first == '\'') return skip_quoted(first);
    if ((first == '|' || first == '>') && !in_brackets) return skip_block_scalar();
    skip_plain(node.scalar);
  }

  void skip_quoted(char quote) {
    for (++cursor_; cursor_ < text_.size(); ++cursor_) {
      if (text_[cursor_] == '\\' && quote == '"') {
        ++cursor_;
      } else if (text_[cursor_] == quote) {
        if (quote == '"' || at(cursor_ + 1) != '\'') {
          ++cursor_;
          return;
        }
        ++cursor_;  // '' stands for '
      }
    }
    stop("a quoted text does not end");
  }

  /// Ends a block scalar before the first line that is not blank and has less indentation than its first one.
  void skip_block_scalar() {
    ++cursor_;
    if (at(cursor_) == '-' || at(cursor_) == '+') ++cursor_;
    cursor_ = after_blanks(cursor_);
    if (at(cursor_) == '#') skip_comment();
    if (at(cursor_) == '\r') ++cursor_;
    if (at(cursor_) != '\n') stop("'shoal upgrade' does not follow a block of text with an indentation indicator");
    cursor_ = std::min(cursor_ + 1, text_.size());
    std::size_t indentation = 0;
    std::size_t end = cursor_;
    for (std::size_t line = cursor_; line < text_.size();
         line = std::min(text_.find('\n', line), text_.size() - 1) + 1) {
      std::size_t first = line;
      while (at(first) == ' ') ++first;
      if (at(first) == '\n' || at(first) == '\r') continue;
      if (indentation == 0) indentation = first - line;
      if (first - line < indentation || indentation == 0) break;
      end = std::min(text_.find('\n', line), text_.size() - 1) + 1;
    }
    cursor_ = end;
  }

  /// Compares the value of a plain scalar with the text; in one of several lines, a line break and the white space
  /// around it represent one space, and each empty line a line break.
  void skip_plain(std::string_view value) {
    for (std::size_t i = 0; i < value.size();) {
      if (cursor_ < text_.size() && text_[cursor_] == value[i] && value[i] != '\n') {
        const std::size_t next = after_blanks(cursor_);
        const bool is_break = next > cursor_ && (at(next) == '\n' || (at(next) == '\r' && at(next + 1) == '\n'));
        if (!is_break) {
          ++cursor_;
          ++i;
          continue;
        }
      }
      i += skip_folded_break(value.substr(i));
    }
    if (value.empty()) return;
    const char next = at(cursor_);
    if (!is_space(next) && next != ':' && flow_indicators.find(next) == std::string_view::npos) stop(not_followed);
  }

  /// Returns the characters of the value that the line break here represents.
  std::size_t skip_folded_break(std::string_view value) {
    std::size_t breaks = 0;
    while (cursor_ < text_.size() && is_space(text_[cursor_])) breaks += text_[cursor_++] == '\n';
    if (breaks == 0) stop(not_followed);
    const std::size_t characters = breaks == 1 ? 1 : breaks - 1;
    const std::string expected(characters, breaks == 1 ? ' ' : '\n');
    if (value.substr(0, characters) != expected) stop(not_followed);
    return characters;
  }

  void place_list(SourceNode& list, bool in_brackets) {
    list.brackets = at(cursor_) == '[';
    if (!list.brackets && in_brackets) stop(not_followed);
    if (list.brackets) ++cursor_;
    for (SourceNode& item : list.items) {
      if (list.brackets) {
        skip_comma();
      } else {
        skip_space();
        if (at(cursor_) != '-') stop(not_followed);
        ++cursor_;
      }
      place_value(item, list.brackets);
    }
    if (list.brackets) skip_bracket(']');
  }

  void skip_comma() {
    skip_space();
    if (at(cursor_) == ',') ++cursor_;
    skip_space();
  }

  void place_map(SourceNode& map, bool in_brackets) {
    map.brackets = at(cursor_) == '{';
    map.pair = !map.brackets && in_brackets;
    if (map.brackets) ++cursor_;
    for (SourceNode::Entry& entry : map.entries) {
      if (map.brackets) skip_comma();
      place_entry(entry, map.brackets || in_brackets);
    }
    if (map.brackets) skip_bracket('}');
  }

  void place_entry(SourceNode::Entry& entry, bool in_brackets) {
    skip_to(entry.key.start);
    place(entry.key, in_brackets);
    const std::size_t colon = after_blanks(cursor_);
    if (at(colon) != ':') stop(in_brackets ? "a key has no value" : not_followed);
    cursor_ = entry.after_colon = colon + 1;
    place_value(entry.value, in_brackets);
  }

  const std::string& text_;
  std::size_t cursor_ = 0;
  std::vector<TextSpan> comments_;
};

}  // namespace

std::vector<TextSpan> find_spans(const std::string& text, SourceNode& root) {
  return SpanFinder(text).find(root);
}

}  // namespace tools
