// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/config_node.hpp"

namespace sim {

/// Pieces of error messages.

/// The text with control characters escaped, so that it stays on one line and commands no terminal.
std::string printable(std::string_view text);

/// At most `limit` bytes of the text, cut between characters and marked with `...`.
std::string shortened(std::string_view text, std::size_t limit = 60);

/// A value as a message shows it: `'heavy'`, `[1, 2]`, `{a: 1}`, `nothing`.
std::string shown(const ConfigNode& node);

/// The shortest text that reads back as the same number; whole numbers without an exponent.
std::string number_text(double value);

/// `joints`, `bodies`.
std::string plural_of(std::string_view word);

/// `a joint`, `an object`.
std::string with_article(std::string_view word);

/// `a, b, c`; `none` when empty; a long list is cut.
std::string list_text(const std::vector<std::string>& names, std::size_t max = 40);

/// The name a misspelt one most likely meant; empty when none is close.
std::string closest_name(std::string_view misspelt, const std::vector<std::string>& names);

/// `; did you mean 'NAME'?` for the name that a misspelt one most likely meant; empty when none is close.  Names that
/// end with a unit are found without it and with another one: `speed_kmh` gives `; did you mean 'speed_mps', in mps?`
std::string did_you_mean(std::string_view misspelt, const std::vector<std::string>& names);

}  // namespace sim
