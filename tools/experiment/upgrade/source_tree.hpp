// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"

namespace tools {

/// Bytes of a text from `begin` up to, but not including, `end`.
struct TextSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  friend bool operator==(const TextSpan&, const TextSpan&) = default;
};

/// Node of a YAML text with the span of its bytes.  Aliases are not resolved.
struct SourceNode {
  enum class Kind { null, scalar, list, map, alias };
  struct Entry;

  Kind kind = Kind::null;
  bool quoted = false;      ///< a scalar in quotes, a block scalar, or one with the tag of text
  bool brackets = false;    ///< a list or map in flow style, `[...]` or `{...}`
  bool pair = false;        ///< a map of one pair without brackets inside a list with brackets: `[key: value]`
  bool properties = false;  ///< a tag or an anchor precedes it
  std::string scalar;
  std::vector<SourceNode> items;    ///< of a list
  std::vector<Entry> entries;       ///< of a map
  std::size_t start = 0;            ///< first byte, tag and anchor included
  TextSpan span;                    ///< tag and anchor excluded
  std::size_t anchor = 0;           ///< number of the anchor that it has, or that an alias names; 0: none
  const SourceNode* target = this;  ///< of an alias: the node that it names

  const Entry* find(std::string_view key) const;
};

struct SourceNode::Entry {
  SourceNode key;
  std::size_t after_colon = 0;
  SourceNode value;
};

/// Reason why a text is not rewritten, and the byte that causes it.
class Doubt : public std::runtime_error {
 public:
  Doubt(std::size_t where, const std::string& text) : std::runtime_error(text), at(where) {}
  std::size_t at;
};

/// YAML text with the position of every node and comment.  sim::parse_config_text() must accept it.
class SourceText {
 public:
  explicit SourceText(std::string text);
  SourceText(const SourceText&) = delete;
  SourceText& operator=(const SourceText&) = delete;

  const std::string& text() const { return text_; }
  const SourceNode& root() const { return root_; }
  /// Reason why the positions of the nodes are unknown, if they are: the text uses a form that is not tracked byte by
  /// byte.
  const std::optional<Doubt>& doubt() const { return doubt_; }
  /// Comments from `#` to the last character of their lines.
  const std::vector<TextSpan>& comments() const { return comments_; }
  /// Comments that start in `span`.
  std::span<const TextSpan> comments_in(TextSpan span) const;
  /// Text of all comments.
  std::vector<std::string> comment_texts() const;

  std::size_t line_begin(std::size_t at) const;
  /// Returns the first byte of the next line, or the end of the text.
  std::size_t line_end(std::size_t at) const;
  /// Number of characters before `at` in its line.
  std::size_t column(std::size_t at) const { return at - line_begin(at); }
  /// Line break that the text uses: `
  /// ` or `\r
  /// `.
  const char* line_break() const;
  sim::SourcePlace place(std::size_t at, const std::string* file) const;

 private:
  std::string text_;
  SourceNode root_;
  std::vector<TextSpan> comments_;
  std::optional<Doubt> doubt_;
};

}  // namespace tools
