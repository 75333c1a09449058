// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"

namespace command_line {

/// Wrong usage of a command, in one line: `unknown option '--durration'; did you mean '--duration'?`
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns user input for an error message: in quotes, printable, shortened.
std::string quoted(const std::string& text);

/// Reads `count` finite numbers with a separator between them, such as `4,-3,2.5`; nullopt for any other text.
std::optional<std::vector<double>> numbers_in(std::string_view text, char separator, std::size_t count);

/// The same for a position in meters, each coordinate within 1e7 m.
std::optional<sim::Vector3d> point_in(std::string_view text);

/// Validators of option values.  Their descriptions appear in the help: `from 0 to 1e9`, `lcm or none`.

/// Accepts a number in a closed range; rejects nan, which CLI::Range accepts.
CLI::Validator number_from(double low, double high);
/// Accepts the same, or a word, which is replaced by 0; for CLI::Option::transform.
CLI::Validator number_or_word(double low, double high, const std::string& word);

/// Accepts a whole number in a closed range.
CLI::Validator whole_from(std::int64_t low, std::int64_t high);

/// Accepts one of these words.
CLI::Validator one_of(std::vector<std::string> words);

/// Accepts a seed: a whole number from 0 to 2^63 - 1.
CLI::Validator seed();

/// Accepts `PATH=VALUE`, the argument of `--set`.
CLI::Validator setting();

/// Accepts any text except the empty one.
CLI::Validator not_empty();

/// Returns a bound as the help prints it: `1e9`, not `1e+09`; `100000`, not `1e5`.
std::string bound_text(double bound);

/// Returns the words as alternatives: `lcm or none`, `a, b or c`.
std::string alternatives(const std::vector<std::string>& words);

}  // namespace command_line
