// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/thread_pool.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "sim/base/shared_work.hpp"
#include "sim/base/time.hpp"

namespace sim {

namespace {

thread_local SharedWork* measured_work = nullptr;

/// Piece of shared work that this thread does.
struct Piece {
  tbb::task_arena* arena = nullptr;  // of its pool; null: none
  bool measured = false;
  // Work within it that threads shared.
  double own_s = 0;        // CPU time of this thread
  double all_s = 0;        // of all threads
  double max_piece_s = 0;  // of the longest part
};
thread_local Piece* piece_of_thread = nullptr;

/// Sets the piece that this thread does.
class InPiece {
 public:
  explicit InPiece(Piece& piece) : before_(std::exchange(piece_of_thread, &piece)) {}
  ~InPiece() { piece_of_thread = before_; }
  InPiece(const InPiece&) = delete;
  InPiece& operator=(const InPiece&) = delete;

 private:
  Piece* before_;
};

void share(tbb::task_arena& arena, std::size_t count, const std::function<void(std::size_t)>& work) {
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, work); });
}

/// Returns the CPU time of each piece of work.
std::vector<double> share_measured(tbb::task_arena& arena, std::size_t count,
                                   const std::function<void(std::size_t)>& work) {
  std::vector<double> took_s(count);
  share(arena, count, [&](std::size_t i) {
    const double before_s = thread_cpu_s();
    work(i);
    took_s[i] = thread_cpu_s() - before_s;
  });
  return took_s;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void for_each_measured(tbb::task_arena& arena, std::size_t count, const std::function<void(std::size_t)>& work) {
  const double start_s = thread_cpu_s();
  std::vector<Piece> pieces(count, Piece{&arena, true});
  const std::vector<double> took_s = share_measured(arena, count, [&](std::size_t i) {
    const InPiece in_piece(pieces[i]);
    work(i);
  });
  double max_piece_s = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // Pieces that were shared further have counted their own share; only the rest of a piece is undivided.
    const double undivided_s = took_s[i] - pieces[i].own_s;
    measured_work->shared_s += undivided_s + pieces[i].all_s;
    max_piece_s = std::max(max_piece_s, undivided_s + pieces[i].max_piece_s);
  }
  measured_work->max_piece_s += max_piece_s;
  measured_work->alone_s -= thread_cpu_s() - start_s;
}

}  // namespace

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
  if (impl_->threads == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  if (measured_work != nullptr) return for_each_measured(impl_->arena, count, work);
  const auto do_piece = [&](std::size_t i) {
    Piece piece{&impl_->arena};
    const InPiece in_piece(piece);
    work(i);
  };
  if (count == 1) return do_piece(0);  // what is within it may be shared
  share(impl_->arena, count, do_piece);
}

void for_each_within(std::size_t count, const std::function<void(std::size_t)>& work) {
  Piece* const piece = piece_of_thread;
  if (piece == nullptr || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  // While it waits, a thread must not begin other pieces, whose state may be that of this one.
  if (!piece->measured) return tbb::this_task_arena::isolate([&] { share(*piece->arena, count, work); });
  const double start_s = thread_cpu_s();
  const std::vector<double> took_s =
      tbb::this_task_arena::isolate([&] { return share_measured(*piece->arena, count, work); });
  piece->own_s += thread_cpu_s() - start_s;
  piece->all_s += sum_of(took_s);
  piece->max_piece_s += took_s.empty() ? 0 : *std::max_element(took_s.begin(), took_s.end());
}

SharedWorkClock::SharedWorkClock(SharedWork* work) : work_(work) {
  if (work_ == nullptr) return;
  measured_work = work_;
  start_s_ = thread_cpu_s();
}

SharedWorkClock::~SharedWorkClock() {
  if (work_ == nullptr) return;
  work_->alone_s += thread_cpu_s() - start_s_;
  ++work_->steps;
  measured_work = nullptr;
}

}  // namespace sim
