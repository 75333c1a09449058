// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/ctd_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "sim/base/number.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

namespace sim {

namespace {

enum CtdColumn : std::size_t { depth, pressure, temperature, salinity, sound, density, ctd_columns };
constexpr std::array<const char*, ctd_columns> ctd_names{"depth_m",      "pressure_dbar",   "temperature_C",
                                                         "salinity_psu", "sound_speed_mps", "density_kgpm3"};
struct CtdRange {
  double min, max;
  bool has(double value) const { return value >= min && value <= max; }
};
/// Limits of the values, as for the rows of a world.
constexpr std::array<CtdRange, ctd_columns> ctd_limits{
    {{-5, 12000}, {-5, 12400}, {-5, 100}, {0, 400}, {100, 10000}, {1, 20000}}};
/// Usual values of natural waters, apart from vents and brine.
constexpr std::array<CtdRange, ctd_columns> ctd_usual{
    {{-5, 12000}, {-5, 12400}, {-5, 45}, {0, 45}, {1350, 1700}, {900, 1300}}};

using CtdRow = std::array<double, ctd_columns>;
struct CtdLine {
  CtdRow values{};
  int number = 0;
  double depth_m() const { return values[depth]; }
};

std::vector<std::string_view> ctd_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    // Quotes are dropped: some programs quote the cells of a header.
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

/// Returns whether a cell is empty or has a word for a missing value.
bool is_no_value(std::string_view cell) {
  std::string word(cell);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return word.empty() || word == "nan" || word == "-nan" || word == "na" || word == "n/a" || word == "null";
}

/// Returns whether a number stands for a missing value: Sea-Bird's bad flag -9.99e-29, the fill values of netCDF
/// (9.97e36) and others, and nines that no water has.
bool is_missing_code(CtdColumn column, double value) {
  constexpr double smallest = 1e-20, largest = 1e10;
  const double size = std::abs(value);
  return (size > 0 && size < smallest) || size > largest || (!ctd_usual[column].has(value) && is_nines(value));
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

using CtdLines = std::vector<CtdLine>;

/// Refuses a deepest row that stands out from the rows beside it by more than `heave_m` and five times their steps. The
/// first and the last row may do so, as in tables of standard depths, unless they are nines.
void check_deepest(const CtdLines& lines, std::size_t at, double heave_m) {
  constexpr double times_step = 5;
  const auto depth_at = [&](std::size_t i) { return lines[i].depth_m(); };
  const bool is_inner = at > 0 && at + 1 < lines.size();
  if (!is_inner && !is_nines(depth_at(at)) && !is_nines(lines[at].values[pressure])) return;
  double beside_m = 0, step_m = 0;
  if (at > 0) beside_m = depth_at(at - 1);
  if (at + 1 < lines.size()) beside_m = std::max(beside_m, depth_at(at + 1));
  if (at > 1) step_m = std::abs(depth_at(at - 1) - depth_at(at - 2));
  if (at + 2 < lines.size()) step_m = std::max(step_m, std::abs(depth_at(at + 1) - depth_at(at + 2)));
  if (const double jump_m = depth_at(at) - beside_m; jump_m > heave_m && step_m > 0 && jump_m > times_step * step_m)
    ctd_fail(lines[at].number, "a depth of " + number_text(depth_at(at)) + " m is a spike: beside it the cast is at " +
                                   number_text(beside_m) + " m; remove the line");
}

/// Refuses a cast towards its deepest row that jumps back by more than `heave_m`.
void check_steps(const CtdLines& cast, double heave_m) {
  for (std::size_t i = 1; i < cast.size(); ++i)
    if (cast[i - 1].depth_m() - cast[i].depth_m() > heave_m)
      ctd_fail(std::max(cast[i - 1].number, cast[i].number),
               "the depth jumps between " + number_text(cast[i - 1].depth_m()) + " and " +
                   number_text(cast[i].depth_m()) +
                   " m, against the direction of the cast: a spike, or more than one cast");
}

/// Refuses a cast towards its deepest row, which is not used, that comes back by more than twice `heave_m`: it is more
/// than one.
void check_unused(const CtdLines& cast, double heave_m) {
  const CtdLine* furthest = nullptr;
  for (const CtdLine& line : cast) {
    if (furthest != nullptr && furthest->depth_m() - line.depth_m() > 2 * heave_m)
      ctd_fail(line.number, "the cast is at " + number_text(line.depth_m()) + " m, but at " +
                                number_text(furthest->depth_m()) + " m in line " + std::to_string(furthest->number) +
                                ", and deepest in line " + std::to_string(cast.back().number) + " at " +
                                number_text(cast.back().depth_m()) + " m: a spike, or more than one cast");
    if (furthest == nullptr || line.depth_m() > furthest->depth_m()) furthest = &line;
  }
}

/// Returns the downcast, or the upcast when it is more than twice as long, in the order of depth and without heave.
std::vector<CtdRow> one_cast(const CtdLines& lines) {
  std::vector<CtdRow> rows;
  if (lines.empty()) return rows;
  const auto by_depth = [](const CtdLine& a, const CtdLine& b) { return a.depth_m() < b.depth_m(); };
  const auto deepest = std::max_element(lines.begin(), lines.end(), by_depth);
  const double min_m = std::min_element(lines.begin(), lines.end(), by_depth)->depth_m();
  const double heave_m = std::clamp((deepest->depth_m() - min_m) / 10, 2.0, 5.0);
  check_deepest(lines, static_cast<std::size_t>(deepest - lines.begin()), heave_m);
  // Both casts, towards the deepest row.
  CtdLines down(lines.begin(), deepest + 1), up(deepest, lines.end());
  std::reverse(up.begin(), up.end());
  const auto length_m = [&](const CtdLines& cast) {
    return deepest->depth_m() - std::min_element(cast.begin(), cast.end(), by_depth)->depth_m();
  };
  const bool is_down = length_m(down) >= length_m(up) / 2;
  check_steps(down, heave_m);
  check_steps(up, heave_m);
  check_unused(is_down ? up : down, heave_m);
  for (const CtdLine& line : is_down ? down : up)
    if (rows.empty() || line.depth_m() > rows.back()[depth]) rows.push_back(line.values);
  return rows;
}

/// First of several lines with the same problem.
struct CtdProblem {
  int count = 0;
  int line = 0;
  std::string text;
  void add(int at_line, const std::string& name, std::string_view cell) {
    if (++count > 1) return;
    line = at_line;
    text = name + " '" + printable(shortened(cell)) + "'";
  }
};

/// Parses the rows below the header.
class CtdReader {
 public:
  void read_line(int number, std::string_view line) {
    const std::vector<std::string_view> cells = ctd_cells(line);
    if (has_header_)
      read_row(number, cells);
    else
      read_header(number, cells);
  }

  CtdCast cast() const {
    const std::vector<CtdRow> rows = one_cast(lines_);
    if (rows.size() < 2)
      throw CtdError("needs two rows of increasing depth below the header" +
                     (missing_.count > 0 ? "; " + missing_text() : ""));
    CtdCast cast;
    for (const CtdRow& row : thinned(rows)) {
      WaterLayerConfig& layer = cast.rows.emplace_back();
      layer.depth_m = row[depth];
      layer.temperature_C = row[temperature];
      layer.salinity_psu = row[salinity];
      if (columns_[sound]) layer.sound_speed_mps = row[sound];
      if (columns_[density]) layer.density_kgpm3 = row[density];
    }
    if (missing_.count > 0) cast.warnings.push_back(missing_text());
    for (std::size_t i = 0; i < ctd_columns; ++i)
      if (const CtdProblem& unusual = unusual_[i]; unusual.count > 0)
        cast.warnings.push_back("line " + std::to_string(unusual.line) + ": " + unusual.text +
                                " is unusual for water, which has " + number_text(ctd_usual[i].min) + " to " +
                                number_text(ctd_usual[i].max) +
                                (unusual.count > 1 ? "; in " + std::to_string(unusual.count) + " rows" : ""));
    return cast;
  }

 private:
  void read_header(int number, const std::vector<std::string_view>& cells) {
    for (std::size_t i = 0; i < ctd_names.size(); ++i) {
      const auto found = std::find(cells.begin(), cells.end(), ctd_names[i]);
      if (found != cells.end()) columns_[i] = static_cast<std::size_t>(found - cells.begin());
    }
    if (!columns_[depth] && !columns_[pressure]) ctd_fail(number, "the header must name 'depth_m' or 'pressure_dbar'");
    for (const CtdColumn each : {temperature, salinity})
      if (!columns_[each]) ctd_fail(number, "the header must name '" + std::string(ctd_names[each]) + "'");
    has_header_ = true;
  }

  void read_row(int number, const std::vector<std::string_view>& cells) {
    CtdLine line;
    line.number = number;
    // A row with a missing value is left out as a whole; the profile is interpolated over it.
    for (std::size_t i = 0; i < ctd_columns; ++i) {
      if (!columns_[i]) continue;
      const std::string name = "'" + std::string(ctd_names[i]) + "'";
      if (*columns_[i] >= cells.size()) ctd_fail(number, name + " is missing");
      const std::string_view cell = cells[*columns_[i]];
      double& value = line.values[i];
      if (is_no_value(cell)) return missing_.add(number, name, cell);
      const auto [at, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error == std::errc::result_out_of_range) return missing_.add(number, name, cell);
      const std::string got = ", got '" + printable(shortened(cell)) + "'";
      if (error != std::errc{} || at != cell.data() + cell.size()) ctd_fail(number, name + " is not a number" + got);
      if (is_missing_code(static_cast<CtdColumn>(i), value)) return missing_.add(number, name, cell);
      if (!ctd_limits[i].has(value))
        ctd_fail(number, name + " must be in [" + number_text(ctd_limits[i].min) + ", " +
                             number_text(ctd_limits[i].max) + "]" + got);
      if (!ctd_usual[i].has(value)) unusual_[i].add(number, name, cell);
    }
    // Casts list pressure or depth; the model needs depth. Rows in the air (negative depth), taken before the probe
    // is lowered, are dropped.
    if (!columns_[depth]) line.values[depth] = depth_of_pressure_m(line.values[pressure]);
    if (line.depth_m() >= 0) lines_.push_back(line);
  }

  std::string missing_text() const {
    return (missing_.count == 1 ? "1 row is" : std::to_string(missing_.count) + " rows are") +
           " skipped for missing values, the first in line " + std::to_string(missing_.line) + ": " + missing_.text;
  }

  std::array<std::optional<std::size_t>, ctd_columns> columns_;
  bool has_header_ = false;
  CtdLines lines_;
  CtdProblem missing_;
  std::array<CtdProblem, ctd_columns> unusual_;
};

}  // namespace

double depth_of_pressure_m(double pressure_dbar) {
  constexpr double x = 0.5;  // squared sine of the latitude
  const double p = pressure_dbar, gravity = 9.780318 * (1 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p;
  return (((-1.82e-15 * p + 2.279e-10) * p - 2.2512e-5) * p + 9.72659) * p / gravity;
}

CtdCast parse_ctd(std::string_view text) {
  text = without_byte_order_mark(text);
  CtdReader reader;
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (line.find_first_not_of(" \t\r") != line.npos && line[0] != '#') reader.read_line(number, line);
  }
  return reader.cast();
}

CtdCast read_ctd_file(const std::string& path) {
  constexpr std::uintmax_t most_mb = 50;
  return parse_ctd(whole_file<CtdError>(path, most_mb));
}

}  // namespace sim
