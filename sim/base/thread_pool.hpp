// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace sim {

/// Thread pool for the work of one step.  The assignment of work to threads is undefined; results must not depend on
/// it.
class ThreadPool {
 public:
  /// `threads`: number including the calling thread; 0: one for each processor.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  int threads() const;
  /// Calls work(0) to work(count - 1) and returns when all calls have returned.  Throws an exception of one of them.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
