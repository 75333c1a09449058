// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace tools {

/// Returns the vehicle file of an imported robot.  `schema`: path of vehicle.schema.json for editors; empty: none.
/// Computed numbers have 10 digits.
std::string vehicle_text(const ImportedVehicle& vehicle, const std::string& schema);

/// A map of YAML on one or more lines: `{name: left, axis: [0, 1, 0]}`.
class FlowMap {
 public:
  void add(const std::string& key, const std::string& value) { entries_.emplace_back(key, value); }
  /// Adds a text, in quotes where YAML needs them.
  void add_text(const std::string& key, const std::string& text);
  void add(const std::string& key, double value);
  void add(const std::string& key, const sim::Vector3d& value);
  /// Adds a vector that is not zero.
  void add_unless_zero(const std::string& key, const sim::Vector3d& value);

  void add(const YamlEntries& entries);
  bool empty() const { return entries_.empty(); }
  const YamlEntries& entries() const { return entries_; }

  /// Returns the map on one line.
  std::string text() const;
  /// Returns `prefix` and the map, broken between entries where a line would exceed 120 columns.
  std::string lines(const std::string& prefix) const;

 private:
  YamlEntries entries_;
};

/// Returns a number with at most 10 significant digits, `0` below 1e-12.
std::string short_number(double value);

/// Returns `[x, y, z]` or a longer list of such numbers.
std::string short_list(const std::vector<double>& values);

/// Returns a text as YAML, in quotes where they are needed.
std::string yaml_scalar(const std::string& text);

}  // namespace tools
