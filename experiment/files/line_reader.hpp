// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/diagnostics.hpp"

namespace experiment {

/// Piece of a line, and its column from 1.
struct Word {
  std::string_view text;
  int column = 1;
};

/// Reader of the lines of a text.  Errors are sim::ConfigError: `file:line:column: rule, value`.
class LineReader {
 public:
  LineReader(std::string_view text, const std::string& file);

  /// Goes to the next line, which ends with LF, CR LF or the text; false: there is none.
  bool next();
  std::string_view line() const { return line_; }
  int number() const { return number_; }
  sim::SourcePlace place(int column) const;
  [[noreturn]] void fail(int column, const std::string& text) const;
  [[noreturn]] void fail(const Word& word, const std::string& rule) const;  ///< with the value

  /// Splits the line at commas; spaces around a word are not part of it.
  std::vector<Word> split_at_commas() const;
  /// Splits the line at white space.
  std::vector<Word> split_at_spaces() const;
  /// Reads a number.
  double number_of(const Word& word, double low, double high, const char* what) const;
  std::int64_t whole_of(const Word& word, std::int64_t low, std::int64_t high, const char* what) const;

 private:
  std::string_view text_;
  const std::string* file_;
  std::size_t at_ = 0;
  std::string_view line_;
  int number_ = 0;
};

/// Returns text in quotes for an error: printable and shortened.
std::string text_in_quotes(std::string_view text);

}  // namespace experiment
