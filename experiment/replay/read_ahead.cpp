// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/read_ahead.hpp"

#include <new>
#include <span>
#include <string_view>
#include <utility>

namespace experiment {

namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 18;
constexpr std::size_t block_events = 4096;

}  // namespace

ReadAhead::ReadAhead(const std::string& path) : file_(path), thread_([this] { read(); }) {}

ReadAhead::~ReadAhead() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ReadAhead::fill(Block& block) {
  block.events.clear();
  block.bytes.clear();
  bridges::LogEventView event;
  while (block.events.size() < block_events && block.bytes.size() < block_bytes) {
    if (!file_.next(event)) {
      block.last = true;
      return;
    }
    const std::size_t begin = block.bytes.size();
    const auto channel = std::as_bytes(std::span(event.channel));
    block.bytes.insert(block.bytes.end(), channel.begin(), channel.end());
    block.bytes.insert(block.bytes.end(), event.payload.begin(), event.payload.end());
    block.events.push_back(
        {event.number, event.utime, event.offset, begin, event.channel.size(), event.payload.size()});
  }
}

void ReadAhead::read() {
  for (Block block; !block.last;) {
    try {
      fill(block);
    } catch (const std::bad_alloc&) {  // events read so far are compared, and the others are missing
      block.last = true;
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !ready_ || stop_; });
    if (stop_) return;
    const bool last = block.last;
    ready_ = std::move(block);
    block = used_ ? std::move(*used_) : Block{};
    block.last = last;
    used_.reset();
    lock.unlock();
    changed_.notify_all();
  }
}

bool ReadAhead::wait_for_block() {
  if (current_.last) return false;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ready_.has_value(); });
  used_ = std::exchange(current_, std::move(*ready_));
  ready_.reset();
  lock.unlock();
  changed_.notify_all();
  at_ = 0;
  return true;
}

bool ReadAhead::next(bridges::LogEventView& event) {
  while (at_ == current_.events.size())
    if (!wait_for_block()) return false;
  const Event& read = current_.events[at_++];
  const std::byte* begin = current_.bytes.data() + read.begin;
  event.number = read.number;
  event.utime = read.utime;
  event.offset = read.offset;
  event.channel = {reinterpret_cast<const char*>(begin), read.channel_bytes};
  event.payload = {begin + read.channel_bytes, read.payload_bytes};
  return true;
}

}  // namespace experiment
