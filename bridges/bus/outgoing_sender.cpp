// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/outgoing_sender.hpp"

namespace bridges {

OutgoingSender::OutgoingSender(const OutgoingQueue::Limits& limits, Send send)
    : send_(std::move(send)), queue_(limits), thread_([this] { run(); }) {}

OutgoingSender::~OutgoingSender() {
  if (thread_.joinable()) close([] {});
}

void OutgoingSender::close(const std::function<void()>& unblock) {
  queue_.close(Clock::now() + time_to_flush);
  if (!queue_.wait_until_sent(time_to_flush)) unblock();
  thread_.join();
}

void OutgoingSender::run() {
  std::unique_ptr<OutgoingQueue::Entry> entry;
  while ((entry = queue_.next(std::move(entry)))) send_(*entry);
}

void OutgoingSender::help() {
  const Clock::time_point begin = Clock::now();
  // Sending took the simulating thread too long a moment ago: the sending thread does it alone for a while.
  if (begin < help_from_) return queue_.wake();
  std::unique_ptr<OutgoingQueue::Entry> entry;
  while ((entry = queue_.next_if_idle(std::move(entry)))) {
    send_(*entry);
    const Clock::time_point now = Clock::now();
    if (now - begin <= max_help) continue;
    help_from_ = now + time_out_of_help;
    return queue_.hand_over(std::move(entry));
  }
}

}  // namespace bridges
