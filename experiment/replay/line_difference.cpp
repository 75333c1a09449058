// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/line_difference.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

namespace experiment {

namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// lengths[i][j]: length of the longest common subsequence of a from i and b from j.
std::vector<std::vector<std::uint32_t>> common_lengths(const Lines& a, const Lines& b) {
  std::vector<std::vector<std::uint32_t>> lengths(a.size() + 1, std::vector<std::uint32_t>(b.size() + 1));
  for (std::size_t i = a.size(); i-- > 0;)
    for (std::size_t j = b.size(); j-- > 0;)
      lengths[i][j] = a[i] == b[j] ? lengths[i + 1][j + 1] + 1 : std::max(lengths[i + 1][j], lengths[i][j + 1]);
  return lengths;
}

}  // namespace

std::vector<std::string> line_difference(const std::string& first, const std::string& second, std::size_t max) {
  // Remove the common start and end.
  Lines a = lines_of(first), b = lines_of(second);
  std::size_t begin = 0;
  while (begin < a.size() && begin < b.size() && a[begin] == b[begin]) ++begin;
  std::size_t end = 0;
  while (end < a.size() - begin && end < b.size() - begin && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  const auto middle = [&](const Lines& lines) {
    return Lines(lines.begin() + static_cast<std::ptrdiff_t>(begin), lines.end() - static_cast<std::ptrdiff_t>(end));
  };
  a = middle(a);
  b = middle(b);
  // Follow the longest common subsequence.
  std::vector<std::string> result;
  std::size_t count = 0;
  const auto report = [&](char sign, std::size_t line, const std::string& text) {
    if (++count <= max) result.push_back(fmt::format("{} {:>5}  {}", sign, begin + line + 1, text));
  };
  std::size_t i = 0, j = 0;
  if (a.size() * b.size() <= 25'000'000) {
    const auto lengths = common_lengths(a, b);
    while (i < a.size() && j < b.size()) {
      if (a[i] == b[j]) {
        ++i, ++j;
      } else if (lengths[i + 1][j] >= lengths[i][j + 1]) {
        report('-', i, a[i]), ++i;
      } else {
        report('+', j, b[j]), ++j;
      }
    }
  }
  // Remaining lines.
  for (; i < a.size(); ++i) report('-', i, a[i]);
  for (; j < b.size(); ++j) report('+', j, b[j]);
  if (count > max) result.push_back(fmt::format("and {} more lines", count - max));
  return result;
}

}  // namespace experiment
