// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/estimate_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>

#include "experiment/files/line_reader.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {
namespace {

/// UTC of the year 5138, and beyond any run.
constexpr double max_time_s = 1e11;
constexpr double max_position_m = 1e9;
constexpr double max_covariance_m2 = 1e18;

/// Columns that may be named.
const std::vector<std::string>& column_names() {
  static const std::vector<std::string> names = {"t", "x", "y", "z", "xx", "xy", "yy", "xz", "yz", "zz"};
  return names;
}

/// Column of this name; `own`: in a file of `shoal-nav`, which writes `x_m` and `cov_xx_m2`.
std::string column_of(std::string_view name, bool own) {
  if (!own) return std::string(name);
  if (name == "time_s") return "t";
  if (name.starts_with("cov_") && name.ends_with("_m2")) return std::string(name.substr(4, name.size() - 7));
  if (name.size() == 3 && name.ends_with("_m")) return std::string(name.substr(0, 1));
  return std::string(name);
}

/// Index in a row of each column that is read.
using Columns = std::map<std::string, std::size_t>;

bool is_name(const Word& word) {
  return !word.text.empty() && (std::isalpha(static_cast<unsigned char>(word.text.front())) != 0) &&
         word.text != "nan" && word.text != "inf";
}

Columns columns_of_header(const LineReader& reader, const std::vector<Word>& words) {
  const bool own = std::none_of(words.begin(), words.end(), [](const Word& word) { return word.text == "t"; });
  Columns columns;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = column_of(words[i].text, own);
    const auto& names = column_names();
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    if (!columns.emplace(name, i).second) reader.fail(words[i], "each column must be named once");
  }
  for (const char* name : {"t", "x", "y"})
    if (!columns.contains(name))
      reader.fail(1, std::string("the columns must include ") + name +
                         "; columns that are read: " + sim::list_text(column_names()));
  // The height is not an estimate: it has no covariance.
  const auto is_covariance = [](const Word& word) { return word.text == "cov_xx_m2"; };
  if (own && std::any_of(words.begin(), words.end(), is_covariance) && !columns.contains("zz")) columns.erase("z");
  // The covariance is that of the positions.
  const auto require_all = [&](const std::set<std::string>& names) {
    const bool any = std::any_of(names.begin(), names.end(), [&](const auto& name) { return columns.contains(name); });
    for (const std::string& name : names)
      if (any && !columns.contains(name)) reader.fail(1, "a covariance needs the column " + name);
  };
  const bool any_height = columns.contains("xz") || columns.contains("yz") || columns.contains("zz");
  if (any_height && !columns.contains("z")) reader.fail(1, "a covariance with z needs the column z");
  if (columns.contains("z"))
    require_all({"xx", "xy", "yy", "xz", "yz", "zz"});
  else
    require_all({"xx", "xy", "yy"});
  return columns;
}

Columns columns_of_count(const LineReader& reader, std::size_t count) {
  Columns columns = {{"t", 0}, {"x", 1}, {"y", 2}};
  if (count == 4) columns["z"] = 3;
  if (count < 3 || count > 4)
    reader.fail(1, "a CSV without names must have the columns t, x, y or t, x, y, z; got " + std::to_string(count));
  return columns;
}

sim::Matrix3d covariance_of(const LineReader& reader, const std::vector<Word>& words, const Columns& columns) {
  const auto number = [&](const char* name) {
    return reader.number_of(words[columns.at(name)], -max_covariance_m2, max_covariance_m2, name);
  };
  // Without a z column its variance is 1, and only the block of x and y is used.
  sim::Matrix3d P = sim::Matrix3d::Identity();
  P(0, 0) = number("xx");
  P(1, 1) = number("yy");
  P(0, 1) = P(1, 0) = number("xy");
  if (columns.contains("zz")) {
    P(2, 2) = number("zz");
    P(0, 2) = P(2, 0) = number("xz");
    P(1, 2) = P(2, 1) = number("yz");
  }
  if (Eigen::LLT<sim::Matrix3d>(P).info() != Eigen::Success)
    reader.fail(words[columns.at("xx")].column, "the covariance must be positive definite");
  return P;
}

}  // namespace

EstimateFile parse_estimates(std::string_view text, const std::string& file) {
  LineReader reader(text, file);
  EstimateFile estimates;
  std::optional<Columns> columns;
  bool is_csv = false;
  std::size_t width = 0;
  while (reader.next()) {
    // Separate the words.
    const std::string_view line = reader.line();
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] == '#') continue;
    if (width == 0) is_csv = line.find(',') != std::string_view::npos;
    const std::vector<Word> words = is_csv ? reader.split_at_commas() : reader.split_at_spaces();
    if (width == 0) {
      width = words.size();
      if (!is_csv && width != 8)
        reader.fail(1, "must be a TUM file, of 8 columns t x y z qx qy qz qw, or a CSV; got " + std::to_string(width) +
                           (width == 1 ? " column" : " columns"));
      const bool header = is_csv && is_name(words.front());
      columns = header   ? columns_of_header(reader, words)
                : is_csv ? columns_of_count(reader, width)
                         : Columns{{"t", 0}, {"x", 1}, {"y", 2}, {"z", 3}};
      if (header) continue;
    }
    if (words.size() != width)
      reader.fail(
          1, "must have " + std::to_string(width) + " columns, as the first line, got " + std::to_string(words.size()));
    // Read the row.
    EstimateFile::Row row;
    row.time_s = reader.number_of(words[columns->at("t")], -max_time_s, max_time_s, "t");
    if (!estimates.rows.empty() && row.time_s <= estimates.rows.back().time_s)
      reader.fail(words[columns->at("t")], "times must increase");
    const std::array<const char*, 3> axes = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
      if (columns->contains(axes[axis]))
        row.position_m[static_cast<Eigen::Index>(axis)] =
            reader.number_of(words[columns->at(axes[axis])], -max_position_m, max_position_m, axes[axis]);
    for (std::size_t i = 4; i < width && !is_csv; ++i) reader.number_of(words[i], -1.01, 1.01, "a quaternion");
    if (columns->contains("xx")) row.covariance_m2 = covariance_of(reader, words, *columns);
    estimates.rows.push_back(row);
  }
  if (estimates.rows.empty()) reader.fail(1, "must have an estimate");
  estimates.has_height = columns->contains("z");
  return estimates;
}

namespace {

std::runtime_error tum_error(const std::string& path) {
  return std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

TumFile::TumFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw tum_error(path);
  std::fputs("# t x y z qx qy qz qw\n", file_.get());
}

void TumFile::add(double time_s, const sim::Vector3d& p_W, const sim::Quaterniond& q_WB) {
  const std::string line = fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", time_s, p_W.x(),
                                       p_W.y(), p_W.z(), q_WB.x(), q_WB.y(), q_WB.z(), q_WB.w());
  std::fputs(line.c_str(), file_.get());
}

void TumFile::close() {
  const bool bad = std::ferror(file_.get()) != 0;
  if (std::fclose(file_.release()) != 0 || bad) throw tum_error(path_);
}

}  // namespace experiment
