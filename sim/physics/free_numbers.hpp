#pragma once

#include <functional>
#include <queue>
#include <vector>

namespace sim {

/// Numbers 0, 1, 2, ... for things that come and go.  A number given back is used again, the lowest first: which
/// number is next depends only on which are in use, not on the order in which they became free.
class FreeNumbers {
 public:
  int next() const { return free_.empty() ? count_ : free_.top(); }
  int take() {
    const int number = next();
    if (free_.empty())
      ++count_;
    else
      free_.pop();
    return number;
  }
  void give_back(int number) { free_.push(number); }
  /// One more than the highest number ever taken.
  int count() const { return count_; }

 private:
  std::priority_queue<int, std::vector<int>, std::greater<>> free_;
  int count_ = 0;
};

/// The element with a number; the vector grows when the number is its size.
template <typename T>
T& slot(std::vector<T>& all, int number) {
  if (static_cast<std::size_t>(number) >= all.size()) all.resize(static_cast<std::size_t>(number) + 1);
  return all[static_cast<std::size_t>(number)];
}

}  // namespace sim
