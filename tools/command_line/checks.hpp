// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace command_line {

/// Wrong usage of a command, in one line: `unknown option '--durration'; did you mean '--duration'?`
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a user typed, for an error: in quotes, printable, shortened.
std::string quoted(const std::string& text);

/// Checks of an option's value.  Their descriptions stand in the help: `from 0 to 1e9`, `lcm or none`.

/// A number of a closed range; not nan, which CLI::Range lets pass.
CLI::Validator number_from(double low, double high);
/// The same, or a word, which becomes 0; for CLI::Option::transform.
CLI::Validator number_or_word(double low, double high, const std::string& word);

/// A whole number of a closed range.
CLI::Validator whole_from(std::int64_t low, std::int64_t high);

/// One of these words.
CLI::Validator one_of(std::vector<std::string> words);

/// Seeds are whole numbers from 0 to 2^63 - 1.
CLI::Validator seed();

/// `PATH=VALUE`, as `--set` takes it.
CLI::Validator setting();

/// Not the empty text.
CLI::Validator not_empty();

/// As the help prints bounds: `1e9`, not `1e+09`; `100000`, not `1e5`.
std::string bound_text(double bound);

/// `lcm or none`, `a, b or c`.
std::string alternatives(const std::vector<std::string>& words);

}  // namespace command_line
