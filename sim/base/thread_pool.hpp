// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
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

/// Number of objects, such as vehicles, below which sharing short work on them costs more than it saves: waking threads
/// takes 5 to 20 us.
inline constexpr std::size_t min_shared = 64;

/// Calls work(begin, end) for blocks of the numbers 0 to count - 1, in the threads of a pool; as one block when
/// `threads` is null or `count` is below min_shared.
template <typename Work>
void for_each_block(ThreadPool* threads, std::size_t count, const Work& work) {
  if (threads == nullptr || threads->threads() == 1 || count < min_shared) {
    if (count > 0) work(std::size_t{0}, count);
    return;
  }
  constexpr std::size_t block = 32;
  threads->for_each((count + block - 1) / block,
                    [&](std::size_t i) { work(i * block, std::min(count, (i + 1) * block)); });
}

/// Does what ThreadPool::for_each() does, within work that a pool shares: by the threads of that pool.  Elsewhere the
/// calling thread does it alone.  For large pieces such as images, of which there may be fewer than threads.
void for_each_within(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace sim
