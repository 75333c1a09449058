// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/math.hpp"

namespace sim {

/// Axis-aligned box in the world frame.
struct AlignedBox {
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();

  Vector3d center() const { return (low + high) / 2; }
  Vector3d half_extents() const { return (high - low) / 2; }
  bool meets(const AlignedBox& other) const {
    return low.x() <= other.high.x() && other.low.x() <= high.x() && low.y() <= other.high.y() &&
           other.low.y() <= high.y() && low.z() <= other.high.z() && other.low.z() <= high.z();
  }
};

/// Spatial index of boxes: a grid of square cells in the xy-plane.  Each box is stored once, in the cell of its center;
/// queries are enlarged by half the width of the largest box in the grid.  Boxes much larger than the median are stored
/// in a separate list that every query examines.
class BoxGrid {
 public:
  /// Builds the index of the given boxes.
  void build(std::span<const AlignedBox> boxes);
  const AlignedBox& box(int index) const { return boxes_[index]; }

  /// Calls visit(index) for each box that meets `query`, in an order that depends on the boxes only.
  template <typename Visit>
  void find(const AlignedBox& query, Visit&& visit) const {
    for (const int index : large_)
      if (boxes_[index].meets(query)) visit(index);
    if (cells_.empty()) return;
    const int column_low = column(query.low.x() - reach_), column_high = column(query.high.x() + reach_);
    const int row_low = row(query.low.y() - reach_), row_high = row(query.high.y() + reach_);
    for (int r = row_low; r <= row_high; ++r) {
      // Cells of a row are stored consecutively.
      const std::uint32_t end = starts_[r * columns_ + column_high + 1];
      for (std::uint32_t at = starts_[r * columns_ + column_low]; at < end; ++at)
        if (boxes_[cells_[at]].meets(query)) visit(cells_[at]);
    }
  }

 private:
  int column(double x) const { return cell_number((x - low_x_) / cell_m_, columns_); }
  int row(double y) const { return cell_number((y - low_y_) / cell_m_, rows_); }
  static int cell_number(double at, int count) { return at <= 0 ? 0 : at >= count ? count - 1 : static_cast<int>(at); }
  void choose_cells(const std::vector<int>& small);

  std::vector<AlignedBox> boxes_;
  std::vector<int> large_;
  std::vector<int> cells_;             // box indices, cell by cell
  std::vector<std::uint32_t> starts_;  // start of each cell in cells_, and the end
  double low_x_ = 0, low_y_ = 0, cell_m_ = 1, reach_ = 0;
  int columns_ = 1, rows_ = 1;
};

}  // namespace sim
