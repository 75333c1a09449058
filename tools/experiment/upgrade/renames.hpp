// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tools/experiment/upgrade/rewriting.hpp"

namespace tools {

/// Name that has changed in version 0.2.
struct Rename {
  enum class What {
    key,    ///< `path` leads to the map that has the key
    word,   ///< `path` leads to the text: a word, a channel or a message type
    part,   ///< `path` leads to a text with spaces between its words, such as a condition `message on CHANNEL`
    figure  ///< `path` leads to a text with figures, such as `METRIC.FIGURE < 1`; `before` follows the last dot
  };
  What what;
  FileKind kind;
  std::string_view path;  ///< see KeyPath::is
  std::string_view before, after;
};

/// Table of all changed names of keys, words, channels and message types.  The word of an action is not in it, because
/// it decides which keys rewrite_action() moves.
std::span<const Rename> renames();

/// `text`, for example a rule, with the present name of a figure: `before` is replaced where it is a whole name after a
/// dot.
std::string renamed_figure(std::string text, std::string_view before, std::string_view after);

/// A rule in the form of this version with the present names of figures.
std::string renamed_rule(std::string rule, FileKind kind);

/// Applies `table` to a node: to the keys of a map, also within dotted keys, and to the text of a scalar.  In a list of
/// strings each item is its own node.  Where a text is a channel or a type, all of it must equal `before`.
void apply_renames(Site& site, std::span<const Rename> table);

}  // namespace tools
