// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/config_node.hpp"

namespace sim {

/// Pieces of error messages.

/// Returns the text with control characters escaped, so that it is one line without terminal escape sequences.
std::string printable(std::string_view text);

/// Returns at most `limit` bytes of the text, cut between characters and marked with `...`.
std::string shortened(std::string_view text, std::size_t limit = 60);

/// Returns a value in the form used in messages: `'heavy'`, `[1, 2]`, `{a: 1}`, `nothing`.
std::string shown(const ConfigNode& node);

/// Returns the shortest text that parses to the same number; whole numbers without an exponent.
std::string number_text(double value);

/// Returns the plural of a word: `joints`, `bodies`.
std::string plural_of(std::string_view word);

/// Returns a word with its indefinite article: `a joint`, `an object`.
std::string with_article(std::string_view word);

/// Joins names: `a, b, c`; `none` when the list is empty; a long list is cut.
std::string list_text(const std::vector<std::string>& names, std::size_t max = 40);

/// Returns the name closest to a misspelled one; empty when none is close.
std::string closest_name(std::string_view misspelled, const std::vector<std::string>& names);

/// `; did you mean 'NAME'?` for the name that a misspelled one most likely meant; empty when none is close.  Names that
/// end with a unit are found without it and with another one: `speed_kmh` gives `; did you mean 'speed_mps', in m/s?`.
/// A word of other simulators gives that of Shoal (other_names.cpp).
std::string did_you_mean(std::string_view misspelled, const std::vector<std::string>& names);

/// The name in Shoal of what other simulators name differently, such as `hinge` for `revolute`; empty: none.
std::string_view synonym_of(std::string_view word);

}  // namespace sim
