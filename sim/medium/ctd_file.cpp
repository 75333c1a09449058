// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/ctd_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "sim/base/whole_file.hpp"

namespace sim {

namespace {

enum CtdColumn : std::size_t { depth, pressure, temperature, salinity, sound, density, ctd_columns };
constexpr std::array<const char*, ctd_columns> ctd_names{"depth_m",      "pressure_dbar",   "temperature_C",
                                                         "salinity_psu", "sound_speed_mps", "density_kgpm3"};
/// Limits of the values, as for the rows of a world.
constexpr std::array<double, ctd_columns> ctd_least{-5, -5, -5, 0, 100, 1};
constexpr std::array<double, ctd_columns> ctd_most{12000, 12400, 100, 400, 10000, 20000};

using CtdRow = std::array<double, ctd_columns>;

std::vector<std::string_view> ctd_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    const auto begin = cell.find_first_not_of(" \t\r\"");
    cell = begin == cell.npos ? std::string_view{} : cell.substr(begin, cell.find_last_not_of(" \t\r\"") - begin + 1);
    cells.push_back(cell);
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

[[noreturn]] void ctd_fail(int line, const std::string& text) {
  throw CtdError("line " + std::to_string(line) + ": " + text);
}

/// Averages rows in layers of equal thickness.
std::vector<CtdRow> thinned(const std::vector<CtdRow>& rows) {
  if (rows.size() <= ctd_rows) return rows;
  std::vector<CtdRow> means;
  const double top_m = rows.front()[depth], thick_m = (rows.back()[depth] - top_m) / static_cast<double>(ctd_rows);
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    const double layer = std::floor((rows[begin][depth] - top_m) / thick_m);
    CtdRow sum{};
    for (; end < rows.size() && (end == begin || rows[end][depth] < top_m + (layer + 1) * thick_m); ++end)
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += rows[end][i];
    for (double& value : sum) value /= static_cast<double>(end - begin);
    means.push_back(sum);
  }
  return means;
}

}  // namespace

double depth_of_pressure_m(double pressure_dbar) {
  constexpr double x = 0.5;  // squared sine of the latitude
  const double p = pressure_dbar, gravity = 9.780318 * (1 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p;
  return (((-1.82e-15 * p + 2.279e-10) * p - 2.2512e-5) * p + 9.72659) * p / gravity;
}

std::vector<WaterLayerConfig> parse_ctd(std::string_view text) {
  std::array<std::optional<std::size_t>, ctd_columns> columns;
  bool has_header = false;
  std::vector<CtdRow> rows;
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (line.find_first_not_of(" \t\r") == line.npos || line[0] == '#') continue;
    const std::vector<std::string_view> cells = ctd_cells(line);
    // Header: find the columns.
    if (!has_header) {
      for (std::size_t i = 0; i < ctd_names.size(); ++i) {
        const auto found = std::find(cells.begin(), cells.end(), ctd_names[i]);
        if (found != cells.end()) columns[i] = static_cast<std::size_t>(found - cells.begin());
      }
      if (!columns[depth] && !columns[pressure]) ctd_fail(number, "the header must name 'depth_m' or 'pressure_dbar'");
      for (const CtdColumn each : {temperature, salinity})
        if (!columns[each]) ctd_fail(number, "the header must name '" + std::string(ctd_names[each]) + "'");
      has_header = true;
      continue;
    }
    // Row: parse and check the values.
    CtdRow row{};
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!columns[i]) continue;
      const std::string name = "'" + std::string(ctd_names[i]) + "'";
      if (*columns[i] >= cells.size()) ctd_fail(number, name + " is missing");
      const std::string_view cell = cells[*columns[i]];
      const auto [at, error] = std::from_chars(cell.data(), cell.data() + cell.size(), row[i]);
      if (error != std::errc{} || at != cell.data() + cell.size()) ctd_fail(number, name + " is not a number");
      if (!(row[i] >= ctd_least[i] && row[i] <= ctd_most[i]))
        ctd_fail(number, name + " must be in [" + std::to_string(static_cast<int>(ctd_least[i])) + ", " +
                             std::to_string(static_cast<int>(ctd_most[i])) + "]");
    }
    if (!columns[depth]) row[depth] = depth_of_pressure_m(row[pressure]);
    if (row[depth] < 0 || (!rows.empty() && row[depth] <= rows.back()[depth])) continue;
    rows.push_back(row);
  }
  if (rows.size() < 2) throw CtdError("needs two rows of rising depth below the header");
  std::vector<WaterLayerConfig> profile;
  for (const CtdRow& row : thinned(rows)) {
    WaterLayerConfig& layer = profile.emplace_back();
    layer.depth_m = row[depth];
    layer.temperature_C = row[temperature];
    layer.salinity_psu = row[salinity];
    if (columns[sound]) layer.sound_speed_mps = row[sound];
    if (columns[density]) layer.density_kgpm3 = row[density];
  }
  return profile;
}

std::vector<WaterLayerConfig> read_ctd_file(const std::string& path) {
  constexpr std::uintmax_t most_mb = 50;
  return parse_ctd(whole_file<CtdError>(path, most_mb));
}

}  // namespace sim
