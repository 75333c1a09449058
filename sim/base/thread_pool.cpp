// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/thread_pool.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <thread>

namespace sim {

struct ThreadPool::Impl {
  int threads;
  std::optional<tbb::global_control> more;
  tbb::task_arena arena;
};

ThreadPool::ThreadPool(int threads) : impl_(std::make_unique<Impl>()) {
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  impl_->threads = threads > 0 ? threads : processors;
  if (impl_->threads > processors)  // otherwise TBB warns, and uses fewer
    impl_->more.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(impl_->threads));
  impl_->arena.initialize(impl_->threads);
}

ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const {
  return impl_->threads;
}

void ThreadPool::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (impl_->threads == 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  impl_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, work); });
}

}  // namespace sim
