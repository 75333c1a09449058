// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Search for members near a point: a grid of square cells in the horizontal plane, stored as a sorted list.
class Neighborhood {
 public:
  struct Member {
    int number;
    Vector3d p_W;
  };
  /// Builds the grid.  `reach_m`: typical radius of queries.
  void build(std::span<const Member> members, double reach_m);
  /// Finds the numbers of all members within this horizontal distance, in rising order; the result may include some
  /// that are farther away.
  void near(const Vector3d& p_W, double reach_m, std::vector<int>& numbers) const;
  void visit_state(StateArchive& archive) {
    archive(cell_m_, entries_);
    archive.require(cell_m_, 1.0, StateArchive::max_number, "a grid of transducers with cells of a size");
    if (archive.restoring() && !in_order()) archive.fail("the snapshot has transducers in an invalid order");
  }
  /// Whether all members have numbers in [0, count).
  bool numbers_are_below(std::size_t count) const;

 private:
  struct Entry {
    std::int64_t row, column;
    int number;
    void visit_state(StateArchive& archive) { archive(row, column, number); }
  };
  std::int64_t cell(double coordinate_m) const;
  static bool comes_before(const Entry& a, const Entry& b);
  bool in_order() const;

  double cell_m_ = 1;
  std::vector<Entry> entries_;  // by row, column, number
};

}  // namespace sim
