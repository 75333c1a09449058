// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/neighborhood.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sim {

std::int64_t Neighborhood::cell(double coordinate_m) const {
  return static_cast<std::int64_t>(std::floor(std::clamp(coordinate_m / cell_m_, -1e15, 1e15)));
}

void Neighborhood::build(std::span<const Member> members, double reach_m) {
  cell_m_ = std::max(reach_m / 2, 1.0);
  entries_.clear();
  for (const Member& member : members) entries_.push_back({cell(member.p_W.y()), cell(member.p_W.x()), member.number});
  std::sort(entries_.begin(), entries_.end(), comes_before);
}

bool Neighborhood::comes_before(const Entry& a, const Entry& b) {
  return std::tie(a.row, a.column, a.number) < std::tie(b.row, b.column, b.number);
}

bool Neighborhood::in_order() const {
  return std::is_sorted(entries_.begin(), entries_.end(), comes_before);
}

bool Neighborhood::numbers_are_below(std::size_t count) const {
  return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.number >= 0 && static_cast<std::size_t>(entry.number) < count;
  });
}

void Neighborhood::near(const Vector3d& p_W, double reach_m, std::vector<int>& numbers) const {
  numbers.clear();
  const std::int64_t first = cell(p_W.x() - reach_m), last = cell(p_W.x() + reach_m);
  const std::int64_t bottom = cell(p_W.y() - reach_m), top = cell(p_W.y() + reach_m);
  const auto before = [](const Entry& entry, const std::pair<std::int64_t, std::int64_t>& at) {
    return std::tie(entry.row, entry.column) < std::tie(at.first, at.second);
  };
  // Skip rows and columns without members by binary search, so that a large reach costs little.
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::pair{bottom, first}, before);
  while (entry != entries_.end() && entry->row <= top) {
    if (entry->column < first) {
      entry = std::lower_bound(entry, entries_.end(), std::pair{entry->row, first}, before);
    } else if (entry->column > last) {
      entry = std::lower_bound(entry, entries_.end(), std::pair{entry->row + 1, first}, before);
    } else {
      numbers.push_back(entry->number);
      ++entry;
    }
  }
  std::sort(numbers.begin(), numbers.end());
}

}  // namespace sim
