// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace sim {

/// Threads that share the work of one step.  Who does what is open: the work must not depend on it.
class ThreadPool {
 public:
  /// `threads`: including the caller's; 0: one for each processor.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  int threads() const;
  /// Calls work(0) to work(count - 1), and returns when all have.  Throws what one of them threw.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
