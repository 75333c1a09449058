// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "verification/fidelity/fidelity.hpp"

namespace verification {

namespace {

constexpr double largest = 1e9;  ///< limit of the numbers in a reference

[[noreturn]] void fail(const std::string& file, int line, const std::string& text) {
  sim::throw_config_error({sim::intern_file_name(file), line, line > 0 ? 1 : 0}, "", text);
}

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '"') {
      cells.back() += c;
    }
  }
  return cells;
}

}  // namespace

std::size_t FidelityReference::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end())
    fail(file, 1,
         "there is no column '" + sim::shortened(sim::printable(name)) + "'; there are " + sim::list_text(columns));
  return static_cast<std::size_t>(found - columns.begin());
}

namespace {

std::ifstream opened(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail(path, 0, "does not exist");
  if (!std::filesystem::is_regular_file(status)) fail(path, 0, "is not a file");
  std::ifstream in(path);
  if (!in) fail(path, 0, "cannot be read");
  return in;
}

std::vector<double> numbers_of(const std::string& path, int line, const std::string& text) {
  std::vector<double> row;
  for (const std::string& cell : cells_of(text)) {
    const double value = sim::exact_number<double>(cell).value_or(std::nan(""));
    if (!std::isfinite(value))
      fail(path, line, "must have finite numbers, got '" + sim::shortened(sim::printable(cell)) + "'");
    if (std::abs(value) > largest) fail(path, line, "must have numbers from -1e9 to 1e9, got " + sim::shortened(cell));
    row.push_back(value);
  }
  return row;
}

}  // namespace

FidelityReference read_fidelity_reference(const std::string& path) {
  FidelityReference reference;
  reference.file = path;
  // Names of the columns, without units.
  std::ifstream in = opened(path);
  std::string line;
  if (!std::getline(in, line)) fail(path, 0, "is empty");
  for (const std::string& name : cells_of(line)) reference.columns.push_back(name.substr(0, name.find('[')));
  if (reference.columns.front() != "t")
    fail(path, 1,
         "the first column must be t, got '" + sim::shortened(sim::printable(reference.columns.front())) + "'");
  // Rows with increasing time.
  for (int number = 2; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r") continue;
    std::vector<double> row = numbers_of(path, number, line);
    if (row.size() != reference.columns.size())
      fail(path, number,
           "must have " + std::to_string(reference.columns.size()) + " numbers, got " + std::to_string(row.size()));
    if (reference.rows.empty() && row[0] != 0)
      fail(path, number, "the first row must be at t = 0, got " + sim::number_text(row[0]));
    if (!reference.rows.empty() && !(row[0] > reference.rows.back()[0]))
      fail(path, number,
           "the time must rise, got " + sim::number_text(row[0]) + " after " +
               sim::number_text(reference.rows.back()[0]));
    reference.rows.push_back(std::move(row));
  }
  if (reference.rows.size() < 2)
    fail(path, 0, "must have two rows of numbers or more, has " + std::to_string(reference.rows.size()));
  return reference;
}

}  // namespace verification
