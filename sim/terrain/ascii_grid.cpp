// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"
#include "sim/terrain/terrain.hpp"

namespace sim {
namespace {

constexpr double hole = std::numeric_limits<double>::quiet_NaN();

std::string lower_case(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return lower;
}

/// Returns whether a word stands for a missing height: as GDAL writes NaN, also on Windows, and `null`.
bool is_hole_word(std::string_view word) {
  const std::string lower = lower_case(word);
  for (const char* each : {"nan", "-nan", "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#ind", "null"})
    if (lower == each) return true;
  return false;
}

/// Splits a text into words and counts lines.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}
  int line() const { return line_; }
  /// Returns the next word; empty at the end.
  std::string_view next() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_space(rest_[begin])) line_ += rest_[begin++] == '\n';
    std::size_t end = begin;
    while (end < rest_.size() && !is_space(rest_[end])) ++end;
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }
  /// Returns the next word without consuming it.
  std::string_view peek() const { return Words(*this).next(); }
  [[noreturn]] void fail(const std::string& text) const {
    throw TerrainError("line " + std::to_string(line_) + ": " + text);
  }
  /// Returns a number, or NaN for a word that stands for a missing one.
  double number_or_hole(const std::string& what) { return is_hole_word(peek()) ? (next(), hole) : number(what); }
  double number(const std::string& what) {
    std::string_view word = next();
    if (word.empty()) fail("the file ends before " + what);
    if (word[0] == '+') word.remove_prefix(1);
    const std::optional<double> value = exact_number<double>(word);
    if (!value) fail(what + " is not a number, got '" + printable(shortened(word)) + "'");
    if (!std::isfinite(*value)) fail(what + " is not finite");
    return *value;
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  std::string_view rest_;
  int line_ = 1;
};

struct Header {
  std::optional<double> ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize, dx, dy, nodata_value;

  std::optional<double>* find(const std::string& key) {
    const std::pair<const char*, std::optional<double>*> keys[] = {{"ncols", &ncols},
                                                                   {"nrows", &nrows},
                                                                   {"xllcorner", &xllcorner},
                                                                   {"yllcorner", &yllcorner},
                                                                   {"xllcenter", &xllcenter},
                                                                   {"yllcenter", &yllcenter},
                                                                   {"cellsize", &cellsize},
                                                                   {"nodata_value", &nodata_value},
                                                                   {"dx", &dx},
                                                                   {"dy", &dy}};
    for (const auto& [name, value] : keys)
      if (key == name) return value;
    return nullptr;
  }
};

bool is_word(std::string_view word) {
  return !word.empty() && ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z')) &&
         !is_hole_word(word) && lower_case(word) != "inf";
}

Header read_header(Words& words) {
  // Read pairs of keyword and number.
  Header header;
  while (is_word(words.peek())) {
    const std::string key = lower_case(words.next());
    std::optional<double>* value = header.find(key);
    if (value == nullptr) words.fail("unknown key of an ESRI ASCII grid");
    if (*value) words.fail("'" + key + "' comes twice");
    *value = key == "nodata_value" ? words.number_or_hole(key) : words.number(key);
  }
  // Check that required keywords are present.
  const auto need = [&](const std::optional<double>& value, const char* name) {
    if (!value) words.fail("is not an ESRI ASCII grid: '" + std::string(name) + "' is missing before the heights");
  };
  need(header.ncols, "ncols");
  need(header.nrows, "nrows");
  // GDAL writes dx and dy where they differ in any digit.
  if (header.dx && header.dy && !header.cellsize) {
    if (std::abs(*header.dx - *header.dy) > 1e-6 * std::abs(*header.dx))
      words.fail("cells must be square, but 'dx' is " + number_text(*header.dx) + " and 'dy' " +
                 number_text(*header.dy));
    header.cellsize = header.dx;
  }
  need(header.cellsize, "cellsize");
  need(header.xllcorner ? header.xllcorner : header.xllcenter, "xllcorner");
  need(header.yllcorner ? header.yllcorner : header.yllcenter, "yllcorner");
  // Check the values.
  if (!(*header.cellsize > 0)) words.fail("cellsize must be > 0, got " + number_text(*header.cellsize));
  if (*header.cellsize < HeightGrid::min_cell_m || *header.cellsize > HeightGrid::max_place_m)
    words.fail("cellsize must be from 0.0001 to 1e7 m, got " + number_text(*header.cellsize));
  for (const double count : {*header.ncols, *header.nrows})
    if (count != std::floor(count) || std::abs(count) > 1e15)
      words.fail("ncols and nrows must be whole numbers, got " + number_text(count));
  check_grid_size(static_cast<std::int64_t>(*header.ncols), static_cast<std::int64_t>(*header.nrows));
  return header;
}

/// Fills each hole with the height of the nearest valid point, by a distance transform (Danielsson, Euclidean distance
/// mapping, 1980).  Of equally distant points the first found is used.
void fill_nearest(HeightGrid& grid) {
  const HeightGrid before = grid;
  // Start with the valid points.
  std::vector<std::pair<int, int>> nearest(grid.heights_m.size(), {-1, -1});
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j) * grid.columns + i; };
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i)
      if (!std::isnan(grid.at(i, j))) nearest[index(i, j)] = {i, j};
  // Replace the nearest point by that of a neighbor if it is closer.
  const auto offer = [&](int i, int j, int from_i, int from_j) {
    if (from_i < 0 || from_j < 0 || from_i >= grid.columns || from_j >= grid.rows) return;
    const auto [a, b] = nearest[index(from_i, from_j)];
    if (a < 0) return;
    auto& best = nearest[index(i, j)];
    const double now = std::hypot(best.first - i, best.second - j), offered = std::hypot(a - i, b - j);
    if (best.first < 0 || offered < now) best = {a, b};
  };
  // Propagate northwards, then southwards.
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i)
      for (const auto& [di, dj] : {std::pair{-1, 0}, {0, -1}, {-1, -1}, {1, -1}}) offer(i, j, i + di, j + dj);
    for (int i = grid.columns - 1; i >= 0; --i) offer(i, j, i + 1, j);
  }
  for (int j = grid.rows - 1; j >= 0; --j) {
    for (int i = grid.columns - 1; i >= 0; --i)
      for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) offer(i, j, i + di, j + dj);
    for (int i = 0; i < grid.columns; ++i) offer(i, j, i - 1, j);
  }
  // Copy the heights.
  for (std::size_t k = 0; k < grid.heights_m.size(); ++k)
    grid.heights_m[k] = before.at(nearest[k].first, nearest[k].second);
}

/// Fills holes by linear interpolation across the gap in the row and across the gap in the column, weighted by the
/// inverse lengths of the gaps.  Holes without valid points on both sides, in either direction, take the nearest
/// height.
void fill_linear(HeightGrid& grid) {
  const HeightGrid before = grid;
  std::vector<double> sums(grid.heights_m.size(), 0), weights(grid.heights_m.size(), 0);
  // Interpolate across the gaps of all lines in one direction.
  const auto cross = [&](int lines, int points, auto&& index) {
    for (int line = 0; line < lines; ++line) {
      int last = -1;
      for (int k = 0; k < points; ++k) {
        if (std::isnan(before.heights_m[index(line, k)])) continue;
        const double from = last < 0 ? 0 : before.heights_m[index(line, last)];
        const double to = before.heights_m[index(line, k)];
        for (int m = last + 1; last >= 0 && m < k; ++m) {
          const double weight = 1.0 / (k - last);
          sums[index(line, m)] += weight * (from + (to - from) * (m - last) / (k - last));
          weights[index(line, m)] += weight;
        }
        last = k;
      }
    }
  };
  // Along rows, then along columns.
  const auto columns = static_cast<std::size_t>(grid.columns);
  cross(grid.rows, grid.columns, [&](int row, int k) { return row * columns + k; });
  cross(grid.columns, grid.rows, [&](int column, int k) { return k * columns + column; });
  // Weighted mean; nearest height where neither line has a value.
  for (std::size_t k = 0; k < sums.size(); ++k)
    if (std::isnan(grid.heights_m[k]) && weights[k] > 0) grid.heights_m[k] = sums[k] / weights[k];
  fill_nearest(grid);
}

}  // namespace

HeightGrid parse_ascii_grid(std::string_view text, double vertical_scale, Holes holes, const std::string& quantity) {
  text = without_byte_order_mark(text);
  // Geometry of the grid from the header.
  Words words(text);
  const Header header = read_header(words);
  HeightGrid grid;
  grid.columns = static_cast<int>(*header.ncols);
  grid.rows = static_cast<int>(*header.nrows);
  grid.cell_m = *header.cellsize;
  grid.west_m = header.xllcenter ? *header.xllcenter : *header.xllcorner + grid.cell_m / 2;
  grid.south_m = header.yllcenter ? *header.yllcenter : *header.yllcorner + grid.cell_m / 2;
  // Each height takes two characters or more.  Check the length of the file before memory is allocated.
  const std::size_t count = static_cast<std::size_t>(grid.columns) * grid.rows;
  if (text.size() < 2 * count - 1)
    throw TerrainError("is too short for " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                       " heights");
  // Heights, from north to south.
  grid.heights_m.resize(count);
  const double nodata = header.nodata_value.value_or(-9999);
  std::size_t holes_found = 0;
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column) {
      const double value = words.number_or_hole(quantity + " " + std::to_string(column + 1) + " of row " +
                                                std::to_string(grid.rows - row));
      const bool is_hole = value == nodata || std::isnan(value);
      if (is_hole && ++holes_found == 1 && holes == Holes::error)
        words.fail("a hole (NODATA) at column " + std::to_string(column + 1) + " of row " +
                   std::to_string(grid.rows - row) + ": fill holes with 'holes: nearest' or 'holes: linear'");
      grid.at(column, row) = is_hole ? hole : value * vertical_scale;
    }
  // Check the end of the file and fill holes.
  if (!words.next().empty()) words.fail("there are more heights than ncols times nrows");
  if (holes_found == count) throw TerrainError("has no heights, only NODATA");
  if (holes_found > 0) holes == Holes::nearest ? fill_nearest(grid) : fill_linear(grid);
  return grid;
}

}  // namespace sim
