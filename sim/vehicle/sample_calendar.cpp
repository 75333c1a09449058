// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/sample_calendar.hpp"

#include <algorithm>

namespace sim {

void SampleCalendar::clear(std::int64_t step) {
  for (std::vector<std::uint32_t>& list : ring_) list.clear();
  later_.clear();
  next_ = step;
  end_ = step + steps;
}

void SampleCalendar::add(std::uint32_t sensor, std::int64_t due_step) {
  due_step = std::max(due_step, next_);
  if (due_step < end_)
    at(due_step).push_back(sensor);
  else
    later_.push_back({sensor, due_step});
}

void SampleCalendar::remove(std::uint32_t sensor, std::int64_t due_step) {
  due_step = std::max(due_step, next_);
  if (due_step < end_)
    std::erase(at(due_step), sensor);
  else
    std::erase_if(later_, [&](const Later& each) { return each.sensor == sensor; });
}

void SampleCalendar::take(std::int64_t step, std::vector<std::uint32_t>& due) {
  for (; next_ <= step; ++next_) {
    std::vector<std::uint32_t>& list = at(next_);
    due.insert(due.end(), list.begin(), list.end());
    list.clear();
    if (next_ + 1 < end_) continue;
    // The ring is empty: take those of its next turn out of the later ones.
    end_ = next_ + 1 + steps;
    std::erase_if(later_, [&](const Later& each) {
      if (each.due_step >= end_) return false;
      at(each.due_step).push_back(each.sensor);
      return true;
    });
  }
}

}  // namespace sim
