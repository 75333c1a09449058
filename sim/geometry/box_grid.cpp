// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/box_grid.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

double width_of(const AlignedBox& box) {
  return std::max(box.high.x() - box.low.x(), box.high.y() - box.low.y());
}

}  // namespace

void BoxGrid::build(std::span<const AlignedBox> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  large_.clear();
  cells_.clear();
  if (boxes_.empty()) return;
  // Median width of the boxes.
  std::vector<double> widths;
  for (const AlignedBox& box : boxes_) widths.push_back(width_of(box));
  std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
  const double median_m = widths[widths.size() / 2];
  // Separate large boxes from small ones.
  std::vector<int> small;
  reach_ = 0;
  for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) {
    const double width = width_of(boxes_[i]);
    if (width > 8 * median_m) {
      large_.push_back(i);
    } else {
      small.push_back(i);
      reach_ = std::max(reach_, width / 2);
    }
  }
  choose_cells(small);

  // Sort boxes into cells (counting sort).
  const auto cell_of = [&](int index) {
    const Vector3d center = boxes_[index].center();
    return row(center.y()) * columns_ + column(center.x());
  };
  starts_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  for (const int index : small) ++starts_[cell_of(index) + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  cells_.resize(small.size());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (const int index : small) cells_[next[cell_of(index)]++] = index;
}

void BoxGrid::choose_cells(const std::vector<int>& small) {
  AlignedBox bounds = boxes_[small.front()];
  for (const int index : small) {
    bounds.low = bounds.low.cwiseMin(boxes_[index].low);
    bounds.high = bounds.high.cwiseMax(boxes_[index].high);
  }
  const Vector3d size = bounds.high - bounds.low;
  low_x_ = bounds.low.x();
  low_y_ = bounds.low.y();
  // About one box per cell, and at most 1024 cells along each axis.
  const double count = static_cast<double>(small.size());
  cell_m_ = std::max({std::sqrt(size.x() * size.y() / count), std::max(size.x(), size.y()) / 1024, 1e-3});
  columns_ = std::max(1, static_cast<int>(std::ceil(size.x() / cell_m_)));
  rows_ = std::max(1, static_cast<int>(std::ceil(size.y() / cell_m_)));
}

}  // namespace sim
