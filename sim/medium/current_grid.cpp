// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/current_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "sim/base/number.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"
#include "sim/terrain/terrain.hpp"

namespace sim {

namespace {

constexpr double fastest_mps = 100;
/// No current is so fast, so that nines above it are a code.
constexpr double fastest_code_free_mps = 9.5;

struct CsvRow {
  double x_m, y_m, east_mps, north_mps;
};

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

[[noreturn]] void fail(int line, const std::string& text) {
  throw TerrainError("line " + std::to_string(line) + ": " + text);
}

std::string bytes_of(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw TerrainError("is not a file");
  return whole_file<TerrainError>(path);
}

/// Reads the rows of a CSV file.  Columns may have any order; unknown ones are ignored.
std::vector<CsvRow> parse_rows(std::string_view text) {
  constexpr std::array<const char*, 4> names{"x_m", "y_m", "east_mps", "north_mps"};
  std::array<std::size_t, 4> columns{};
  std::vector<CsvRow> rows;
  bool has_header = false;
  text = without_byte_order_mark(text);
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (line.empty() || line[0] == '#') continue;
    const auto cells = split(line);
    // Header: find the columns.
    if (!has_header) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        const auto found = std::find(cells.begin(), cells.end(), names[i]);
        if (found == cells.end())
          fail(number,
               "the header must name x_m, y_m, east_mps and north_mps; '" + std::string(names[i]) + "' is missing");
        columns[i] = static_cast<std::size_t>(found - cells.begin());
      }
      has_header = true;
      continue;
    }
    // Row: parse and check the values.
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (columns[i] >= cells.size()) fail(number, "'" + std::string(names[i]) + "' is missing");
      const std::string_view cell = cells[columns[i]];
      values[i] = exact_number<double>(cell).value_or(std::nan(""));
      if (!std::isfinite(values[i]))
        fail(number, "'" + std::string(names[i]) + "' is not a number, got '" + printable(shortened(cell)) +
                         "'; a grid in a CSV file must have all its points");
    }
    for (int i = 0; i < 2; ++i)
      if (std::abs(values[static_cast<std::size_t>(i)]) > 1e8) fail(number, "a place must be within 1e8 m");
    rows.push_back({values[0], values[1], values[2], values[3]});
  }
  return rows;
}

/// Returns the sorted coordinates of the rows along one axis; they must be equally spaced.
std::vector<double> places_along(const std::vector<CsvRow>& rows, double CsvRow::*axis, const char* name) {
  std::vector<double> places;
  for (const CsvRow& row : rows) places.push_back(row.*axis);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  if (places.size() < 2) throw TerrainError("must have two or more values of " + std::string(name));
  const double cell = (places.back() - places.front()) / static_cast<double>(places.size() - 1);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::abs(places[i] - places[0] - cell * static_cast<double>(i)) > 1e-3 * cell)
      throw TerrainError("is not a regular grid: the values of " + std::string(name) + " are not equally spaced at " +
                         number_text(places[i]));
  return places;
}

}  // namespace

CurrentGrid::CurrentGrid(const CurrentConfig& config) : edge_(config.outside == CurrentConfig::Outside::edge) {
  const std::filesystem::path folder(config.directory);
  std::string path = (folder / config.file).string();
  try {
    if (!config.file.empty()) {
      read_csv(bytes_of(path));
    } else {
      path = (folder / config.east_file).string();
      read_esri(path, (folder / config.north_file).string());
    }
    // Codes for missing values (9999, -99.9) pass as numbers; a current of that speed would carry vehicles away
    // without an error.
    for (const auto& v : velocities_mps_)
      if (const double speed = v.cwiseAbs().maxCoeff(); speed > fastest_mps)
        throw TerrainError("has a current of " + number_text(speed) + " m/s, more than 100");
      else if (speed > fastest_code_free_mps && is_nines(speed))
        throw TerrainError("has a current of " + number_text(speed) +
                           " m/s, which is a code for a missing value: an ESRI grid names it by NODATA_value");
  } catch (const TerrainError& error) {
    const std::string text = error.what();
    throw TerrainError(text.starts_with("file ") ? text : "file '" + path + "' " + text);
  }
  west_m_ -= config.map_origin_m[0];
  south_m_ -= config.map_origin_m[1];
}

void CurrentGrid::read_csv(std::string_view text) {
  const std::vector<CsvRow> rows = parse_rows(text);
  if (rows.empty()) throw TerrainError("has no rows");
  // Determine the grid.
  const auto xs = places_along(rows, &CsvRow::x_m, "x_m"), ys = places_along(rows, &CsvRow::y_m, "y_m");
  if (xs.size() * ys.size() != rows.size())
    throw TerrainError("must have one row for each of " + std::to_string(xs.size()) + " x " +
                       std::to_string(ys.size()) + " points, has " + std::to_string(rows.size()));
  columns_ = static_cast<int>(xs.size());
  rows_ = static_cast<int>(ys.size());
  west_m_ = xs[0];
  south_m_ = ys[0];
  cell_x_m_ = (xs.back() - xs[0]) / (columns_ - 1);
  cell_y_m_ = (ys.back() - ys[0]) / (rows_ - 1);
  // Fill the grid; each point must occur once.
  velocities_mps_.resize(rows.size());
  std::vector<bool> filled(rows.size(), false);
  for (const CsvRow& row : rows) {
    const auto i = static_cast<std::size_t>(std::lower_bound(xs.begin(), xs.end(), row.x_m) - xs.begin());
    const auto j = static_cast<std::size_t>(std::lower_bound(ys.begin(), ys.end(), row.y_m) - ys.begin());
    const std::size_t index = j * xs.size() + i;
    if (filled[index])
      throw TerrainError("has the point " + number_text(row.x_m) + ", " + number_text(row.y_m) + " twice");
    filled[index] = true;
    velocities_mps_[index] = {row.east_mps, row.north_mps};
  }
}

void CurrentGrid::read_esri(const std::string& east_path, const std::string& north_path) {
  const auto read = [](const std::string& path) {
    try {
      return parse_ascii_grid(bytes_of(path), 1, Holes::nearest, "current");
    } catch (const TerrainError& error) {
      throw TerrainError("file '" + path + "' " + error.what());
    }
  };
  const HeightGrid east = read(east_path), north = read(north_path);
  // The velocity at a point is read from two files, so both must have the same points.
  if (east.columns != north.columns || east.rows != north.rows || east.cell_m != north.cell_m ||
      east.west_m != north.west_m || east.south_m != north.south_m)
    throw TerrainError("file '" + north_path + "' must have the points of '" + east_path + "'");
  columns_ = east.columns;
  rows_ = east.rows;
  cell_x_m_ = cell_y_m_ = east.cell_m;
  west_m_ = east.west_m;
  south_m_ = east.south_m;
  for (std::size_t i = 0; i < east.heights_m.size(); ++i)
    velocities_mps_.emplace_back(east.heights_m[i], north.heights_m[i]);
}

Vector3d CurrentGrid::velocity_W(double x_m, double y_m) const {
  if (!edge_ && !contains(x_m, y_m)) return Vector3d::Zero();
  const double u = std::clamp((x_m - west_m_) / cell_x_m_, 0.0, static_cast<double>(columns_ - 1));
  const double v = std::clamp((y_m - south_m_) / cell_y_m_, 0.0, static_cast<double>(rows_ - 1));
  // At the last row or column the cell before it is used, with a share of 1.
  const int i = std::min(static_cast<int>(u), columns_ - 2), j = std::min(static_cast<int>(v), rows_ - 2);
  const double a = u - i, b = v - j;
  const auto* at =
      &velocities_mps_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
  const Eigen::Vector2d mixed =
      (1 - b) * ((1 - a) * at[0] + a * at[1]) + b * ((1 - a) * at[columns_] + a * at[columns_ + 1]);
  return {mixed.x(), mixed.y(), 0};
}

}  // namespace sim
