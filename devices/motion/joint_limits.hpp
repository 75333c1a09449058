// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace devices {

/// Range of a joint in which a row of limits holds.
struct JointLimitCondition {
  std::string joint;
  double from_rad = 0, to_rad = 0;
  void read(sim::ParamReader& in);
};

/// Limit of one joint from a position of another one on, until the next row of the same two joints.
struct JointLimitRow {
  std::string joint, by;
  double from_rad = 0;
  std::optional<double> low_rad, high_rad;
  std::optional<JointLimitCondition> when;  ///< range of a third joint
  void read(sim::ParamReader& in);
};

/// Limits of joints that depend on other joints.
class JointLimitTable {
 public:
  /// Range of a joint; unset: no limit.
  struct Range {
    std::optional<double> low, high;
  };

  /// `number_of`: number of a joint by name or alias; none: unknown, for which unknown_joint() returns the name.
  JointLimitTable(const std::vector<JointLimitRow>& rows,
                  const std::function<std::optional<std::size_t>(const std::string&)>& number_of);
  const std::string& unknown_joint() const { return unknown_; }

  /// Returns the range of a joint at the positions of all joints, rad.
  Range range_of(std::size_t joint, std::span<const double> positions) const;
  /// Returns whether the range of a joint depends on the position of another one.
  bool depends_on(std::size_t joint, std::size_t other) const;
  /// Limits the positions, joint by joint.  Returns how many were beyond their limits.
  int limit(std::span<double> positions) const;

 private:
  struct Row {
    double from;
    std::optional<double> low, high;
  };
  /// Rows of two joints in one range of a third, ascending.
  struct Table {
    std::size_t joint, by;
    std::optional<std::size_t> while_joint;
    double while_from = 0, while_to = 0;
    std::vector<Row> rows;
  };
  std::vector<Table> tables_;
  std::string unknown_;
};

}  // namespace devices
