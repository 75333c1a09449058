// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>

namespace sim {

/// Exception of work that threads share: of several, the one of the object with the lowest number.  Thread-safe.
class FirstFailure {
 public:
  /// Takes the present exception, thrown by the work on the object `number`.
  void take(std::size_t number) {
    const std::lock_guard lock(mutex_);
    if (number >= number_) return;
    number_ = number;
    exception_ = std::current_exception();
  }
  /// Throws it; does nothing when there is none.
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::size_t number_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr exception_;
};

}  // namespace sim
