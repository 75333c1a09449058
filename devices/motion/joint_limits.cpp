// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/joint_limits.hpp"

#include <algorithm>
#include <numbers>

namespace devices {

void JointLimitCondition::read(sim::ParamReader& in) {
  in.require("joint");
  in.read("joint", joint, "servo of the third joint, or its alias");
  in.read_deg("from_deg", from_rad, sim::between(-3600, 3600), "lowest position at which the row holds");
  in.read_deg("to_deg", to_rad, sim::between(-3600, 3600), "highest position at which the row holds");
  if (!in.describing() && from_rad > to_rad) in.error("to_deg", "'to_deg' must not be below 'from_deg'");
}

void JointLimitRow::read(sim::ParamReader& in) {
  in.require("joint");
  in.read("joint", joint, "servo of the joint that is limited, or its alias");
  in.require("by");
  in.read("by", by, "servo of the joint on which the limit depends, or its alias");
  in.require("from_deg");
  in.read_deg("from_deg", from_rad, sim::between(-3600, 3600),
              "position of 'by' from which the row holds, until the next row of these two joints");
  std::optional<double> low_deg, high_deg;
  in.read("low_deg", low_deg, sim::between(-3600, 3600), "lower limit of 'joint'; unset: none");
  in.read("high_deg", high_deg, sim::between(-3600, 3600), "upper limit of 'joint'; unset: none");
  in.read("while", when, "range of a third joint in which the row holds; unset: always");
  if (in.describing()) return;
  const auto rad = [](std::optional<double> deg) {
    return deg ? std::optional(*deg * std::numbers::pi / 180) : std::nullopt;
  };
  low_rad = rad(low_deg);
  high_rad = rad(high_deg);
  if (low_deg && high_deg && *low_deg > *high_deg) in.error("high_deg", "'high_deg' must not be below 'low_deg'");
  if (!joint.empty() && joint == by) in.error("by", "'by' must be another joint than 'joint'");
}

JointLimitTable::JointLimitTable(const std::vector<JointLimitRow>& rows,
                                 const std::function<std::optional<std::size_t>(const std::string&)>& number_of) {
  const auto number = [&](const std::string& name) {
    const std::optional<std::size_t> found = number_of(name);
    if (!found && unknown_.empty()) unknown_ = name;
    return found.value_or(0);
  };
  for (const JointLimitRow& row : rows) {
    Table desired{number(row.joint), number(row.by), {}, 0, 0, {}};
    if (row.when) {
      desired.while_joint = number(row.when->joint);
      desired.while_from = row.when->from_rad;
      desired.while_to = row.when->to_rad;
    }
    // Rows of the same joints and condition form one table, a step function of the position of `by`.
    const auto same = [&](const Table& one) {
      return one.joint == desired.joint && one.by == desired.by && one.while_joint == desired.while_joint &&
             one.while_from == desired.while_from && one.while_to == desired.while_to;
    };
    auto table = std::find_if(tables_.begin(), tables_.end(), same);
    if (table == tables_.end()) table = tables_.insert(tables_.end(), std::move(desired));
    table->rows.push_back({row.from_rad, row.low_rad, row.high_rad});
  }
  for (Table& table : tables_)
    std::stable_sort(table.rows.begin(), table.rows.end(), [](const Row& a, const Row& b) { return a.from < b.from; });
}

JointLimitTable::Range JointLimitTable::range_of(std::size_t joint, std::span<const double> positions) const {
  constexpr double rounding_rad = 1e-9;  // a set point exactly at the edge of a row belongs to it
  Range range;
  for (const Table& table : tables_) {
    if (table.joint != joint) continue;
    if (table.while_joint) {
      const double third = positions[*table.while_joint];
      if (third < table.while_from - rounding_rad || third > table.while_to + rounding_rad) continue;
    }
    const Row* active = nullptr;
    for (const Row& row : table.rows)
      if (positions[table.by] >= row.from - rounding_rad) active = &row;
    if (active == nullptr) continue;
    if (active->low) range.low = std::max(range.low.value_or(*active->low), *active->low);
    if (active->high) range.high = std::min(range.high.value_or(*active->high), *active->high);
  }
  return range;
}

bool JointLimitTable::depends_on(std::size_t joint, std::size_t other) const {
  return std::any_of(tables_.begin(), tables_.end(), [&](const Table& table) {
    return table.joint == joint && (table.by == other || table.while_joint == other);
  });
}

int JointLimitTable::limit(std::span<double> positions) const {
  constexpr double rounding_rad = 1e-9;
  int beyond = 0;
  for (std::size_t joint = 0; joint < positions.size() && !tables_.empty(); ++joint) {
    // Limited joints already count at their new positions, in the order of the servos.
    const Range range = range_of(joint, positions);
    double& position = positions[joint];
    if ((range.low && position < *range.low - rounding_rad) || (range.high && position > *range.high + rounding_rad))
      ++beyond;
    if (range.low) position = std::max(position, *range.low);
    if (range.high) position = std::min(position, *range.high);
  }
  return beyond;
}

}  // namespace devices
