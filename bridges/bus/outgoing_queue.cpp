// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/outgoing_queue.hpp"

namespace bridges {
namespace {

// Limits of the memory kept for reuse, so that a burst of images does not remain allocated.
constexpr std::size_t max_free_bytes = std::size_t{8} << 20;
// Messages of a publisher that never calls end_of_step() are also sent.
constexpr std::chrono::milliseconds max_wait{20};

}  // namespace

void OutgoingQueue::push(std::string_view channel, std::span<const std::byte> payload) {
  std::unique_ptr<Entry> entry = free_entry();
  entry->channel.assign(channel);
  entry->payload.assign(payload.begin(), payload.end());
  std::vector<std::unique_ptr<Entry>> too_old;  // freed outside the lock
  bool notify = false;
  {
    const std::lock_guard lock(mutex_);
    waiting_bytes_ += payload.size();
    waiting_.push_back(std::move(entry));
    while (waiting_.size() > limits_.messages || (waiting_bytes_ > limits_.bytes && waiting_.size() > 1)) {
      waiting_bytes_ -= waiting_.front()->payload.size();
      too_old.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
      ++dropped_;
    }
    if (waiting_.size() >= limits_.wake_at && !awake_) awake_ = true, notify = sender_waits_;
  }
  if (notify) sender_.notify_one();
}

void OutgoingQueue::wake() {
  bool notify = false;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty() || awake_) return;
    awake_ = true;
    notify = sender_waits_;
  }
  if (notify) sender_.notify_one();
}

std::unique_ptr<OutgoingQueue::Entry> OutgoingQueue::next(std::unique_ptr<Entry> used) {
  std::unique_lock lock(mutex_);
  if (used) finish(std::move(used));
  sender_waits_ = true;
  // Messages are sent when the publisher ends its step, or after `max_wait` if it never does: waking the sender for
  // each one would cost a context switch per message.
  while (sending_ || (!closed_ && (waiting_.empty() || !awake_))) {
    const bool timed_out = sender_.wait_for(lock, max_wait) == std::cv_status::timeout;
    if (timed_out && !sending_ && !waiting_.empty()) break;
  }
  sender_waits_ = false;
  // A closed bus gets a grace period to send what is queued, so that the last messages of a run are not lost.
  if (closed_ && std::chrono::steady_clock::now() > deadline_) {
    dropped_ += waiting_.size();
    waiting_.clear();
  }
  if (waiting_.empty()) {
    sent_.notify_all();
    return nullptr;
  }
  awake_ = true;
  return take_first();
}

std::unique_ptr<OutgoingQueue::Entry> OutgoingQueue::next_if_idle(std::unique_ptr<Entry> used) {
  const std::lock_guard lock(mutex_);
  if (used) finish(std::move(used));
  return sending_ || waiting_.empty() || closed_ ? nullptr : take_first();
}

void OutgoingQueue::hand_over(std::unique_ptr<Entry> used) {
  {
    const std::lock_guard lock(mutex_);
    finish(std::move(used));
    if (waiting_.empty()) return;
    awake_ = true;
  }
  sender_.notify_one();
}

void OutgoingQueue::finish(std::unique_ptr<Entry> used) {
  recycle(std::move(used));
  sending_ = false;
  if (!waiting_.empty()) return;
  awake_ = false;
  sent_.notify_all();
}

std::unique_ptr<OutgoingQueue::Entry> OutgoingQueue::take_first() {
  std::unique_ptr<Entry> entry = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= entry->payload.size();
  sending_ = true;
  return entry;
}

void OutgoingQueue::close(std::chrono::steady_clock::time_point deadline) {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    deadline_ = deadline;
  }
  sender_.notify_one();
}

bool OutgoingQueue::wait_until_sent(std::chrono::milliseconds timeout) {
  wake();
  std::unique_lock lock(mutex_);
  return sent_.wait_for(lock, timeout, [this] { return waiting_.empty() && !sending_; });
}

std::uint64_t OutgoingQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

std::unique_ptr<OutgoingQueue::Entry> OutgoingQueue::free_entry() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      std::unique_ptr<Entry> entry = std::move(free_.back());
      free_.pop_back();
      free_bytes_ -= entry->payload.capacity();
      return entry;
    }
  }
  // Allocated outside of the lock.
  return std::make_unique<Entry>();
}

void OutgoingQueue::recycle(std::unique_ptr<Entry> entry) {
  if (free_bytes_ + entry->payload.capacity() > max_free_bytes || free_.size() >= limits_.messages) return;
  free_bytes_ += entry->payload.capacity();
  free_.push_back(std::move(entry));
}

}  // namespace bridges
