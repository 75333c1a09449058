// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/background_writer.hpp"

namespace viewer {

BackgroundWriter::BackgroundWriter(std::unique_ptr<FilmWriter> writer)
    : writer_(std::move(writer)), thread_([this] { write(); }) {}

BackgroundWriter::~BackgroundWriter() {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() > 1) waiting_.resize(1);
  }
  stop();
}

void BackgroundWriter::write() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    // References into a deque survive push_back(), so the frame is encoded without the lock, and counts as waiting
    // until it is done.
    const sim::Image8& frame = waiting_.front();
    lock.unlock();
    std::exception_ptr error;
    try {
      writer_->add(frame);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    waiting_.pop_front();
    if (error) {
      error_ = error;
      waiting_.clear();
      ending_ = true;
    }
    changed_.notify_all();
  }
}

void BackgroundWriter::add(const sim::Image8& frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return error_ || waiting_.size() < max_waiting; });
  if (error_) std::rethrow_exception(error_);
  waiting_.push_back(frame);
  changed_.notify_all();
}

void BackgroundWriter::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void BackgroundWriter::finish() {
  stop();
  if (error_) std::rethrow_exception(error_);
  writer_->finish();
}

}  // namespace viewer
