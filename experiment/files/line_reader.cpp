// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/line_reader.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

namespace experiment {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

Word trimmed(Word word) {
  while (!word.text.empty() && is_space(word.text.front())) word.text.remove_prefix(1), ++word.column;
  while (!word.text.empty() && is_space(word.text.back())) word.text.remove_suffix(1);
  return word;
}

/// Reads all of a text as a number in a closed range; `+` may precede it.
template <typename Number>
std::optional<Number> number_within(std::string_view text, Number low, Number high) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto value = sim::exact_number<Number>(text);
  return value && *value >= low && *value <= high ? value : std::nullopt;
}

}  // namespace

LineReader::LineReader(std::string_view text, const std::string& file)
    : text_(sim::without_byte_order_mark(text)), file_(sim::intern_file_name(file)) {}

bool LineReader::next() {
  if (at_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  line_ = text_.substr(at_, end - at_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  at_ = end + 1;
  ++number_;
  return true;
}

sim::SourcePlace LineReader::place(int column) const {
  return {file_, std::max(number_, 1), column};
}

void LineReader::fail(int column, const std::string& text) const {
  sim::throw_config_error(place(column), "", text);
}

void LineReader::fail(const Word& word, const std::string& rule) const {
  fail(word.column, rule + ", got " + text_in_quotes(word.text));
}

std::vector<Word> LineReader::split_at_commas() const {
  std::vector<Word> words;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line_.find(',', begin), line_.size());
    words.push_back(trimmed({line_.substr(begin, end - begin), static_cast<int>(begin) + 1}));
    if (end == line_.size()) return words;
    begin = end + 1;
  }
}

std::vector<Word> LineReader::split_at_spaces() const {
  std::vector<Word> words;
  for (std::size_t begin = 0; begin < line_.size();) {
    if (is_space(line_[begin])) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < line_.size() && !is_space(line_[end])) ++end;
    words.push_back({line_.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = end;
  }
  return words;
}

double LineReader::number_of(const Word& word, double low, double high, const char* what) const {
  if (const auto value = number_within(word.text, low, high)) return *value;
  fail(word, std::string(what) + " must be a number from " + sim::number_text(low) + " to " + sim::number_text(high));
}

std::int64_t LineReader::whole_of(const Word& word, std::int64_t low, std::int64_t high, const char* what) const {
  if (const auto value = number_within(word.text, low, high)) return *value;
  fail(word, std::string(what) + " must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
}

std::string text_in_quotes(std::string_view text) {
  return "'" + sim::shortened(sim::printable(sim::in_utf8(text))) + "'";
}

}  // namespace experiment
