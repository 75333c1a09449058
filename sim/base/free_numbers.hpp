// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace sim {

/// Allocator of the numbers 0, 1, 2, ... for objects that are added and removed.  Released numbers are reused, the
/// lowest first: the next number depends only on which are in use, not on the order in which they were released.
class FreeNumbers {
 public:
  int next() const { return !prescribed_.empty() ? prescribed_.front() : free_.empty() ? count_ : *free_.begin(); }
  int take() {
    const int number = next();
    if (!prescribed_.empty()) prescribed_.pop_front();
    for (; count_ <= number; ++count_) free_.insert(free_.end(), count_);
    free_.erase(number);
    return number;
  }
  void give_back(int number) { free_.insert(number); }
  /// Returns one more than the highest number ever taken.
  int count() const { return count_; }

  /// Sets the next numbers, in this order.  Throws std::out_of_range when one of them is in use or out of range.
  void prescribe(const std::vector<int>& numbers) {
    constexpr int max = 10'000'000;
    for (const int number : numbers)
      if (number < 0 || number >= max || (number < count_ && !free_.contains(number)))
        throw std::out_of_range("number " + std::to_string(number) + " is in use or out of range");
    if (std::set<int>(numbers.begin(), numbers.end()).size() != numbers.size())
      throw std::out_of_range("a number occurs twice");
    prescribed_.assign(numbers.begin(), numbers.end());
  }
  /// Returns whether all prescribed numbers have been taken.
  bool as_prescribed() const { return prescribed_.empty(); }

 private:
  std::set<int> free_;
  std::deque<int> prescribed_;
  int count_ = 0;
};

/// Returns the element with this number; the vector grows when the number is its size.
template <typename T>
T& slot(std::vector<T>& all, int number) {
  if (static_cast<std::size_t>(number) >= all.size()) all.resize(static_cast<std::size_t>(number) + 1);
  return all[static_cast<std::size_t>(number)];
}

}  // namespace sim
