#include "sim/thread_pool.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace sim {

struct ThreadPool::Impl {
  int threads;
  tbb::task_arena arena;
};

ThreadPool::ThreadPool(int threads) : impl_(std::make_unique<Impl>()) {
  impl_->threads = threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
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
