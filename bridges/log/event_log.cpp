// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/event_log.hpp"

#include <endian.h>
#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "bridges/mcap/mcap_format.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {
namespace {

// Per event, big-endian: sync word, number (8), time (8), length of the channel (4), of the data (4).
constexpr std::uint32_t sync_word = 0xEDA1DA01;
constexpr std::size_t header_bytes = 28;
constexpr std::int32_t max_channel_bytes = 1000;  // limit of liblcm for logs
constexpr std::size_t max_problems = 100;
constexpr std::size_t block_bytes = std::size_t{1} << 18;
constexpr std::size_t read_bytes = std::size_t{1} << 17;

std::uint32_t number32(const unsigned char* at) {
  std::uint32_t value;
  std::memcpy(&value, at, sizeof value);
  return be32toh(value);
}

std::uint64_t number64(const unsigned char* at) {
  std::uint64_t value;
  std::memcpy(&value, at, sizeof value);
  return be64toh(value);
}

}  // namespace

EventLogReader::EventLogReader(const std::string& path)
    : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {  // do not block on a pipe
  if (file_.number() < 0) throw BusError(path + ": " + std::strerror(errno));
  struct stat status {};
  if (fstat(file_.number(), &status) != 0) throw BusError(path + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw BusError(path + ": is not a regular file");
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  const bool is_mcap = fill(mcap::magic.size()) >= mcap::magic.size() &&
                       std::memcmp(here(), mcap::magic.data(), mcap::magic.size()) == 0;
  if (is_mcap)
    throw BusError(path +
                   ": is an MCAP file, which lacks data that only the LCM event log of a run has; record with "
                   "--record NAME.lcm, and convert with shoal log mcap");
}

std::optional<LogEvent> EventLogReader::next() {
  LogEventView event;
  if (!next(event)) return std::nullopt;
  return LogEvent{event.number, event.utime, std::string(event.channel),
                  sim::Bytes(event.payload.begin(), event.payload.end()), event.offset};
}

bool EventLogReader::next(LogEventView& event) {
  const auto report = [this](std::uint64_t offset, const std::string& what) {
    if (problems_.size() < max_problems) problems_.push_back("byte " + std::to_string(offset) + ": " + what);
  };
  // Read events; skip to the next sync word after an error.
  while (at_ < file_bytes_) {
    const std::uint64_t start = at_;
    switch (read_event(event)) {
      case Outcome::event:
        return true;
      case Outcome::garbage:
        find_sync();
        report(start, std::to_string(at_ - start) + " bytes between events were skipped");
        break;
      case Outcome::truncated:
        // A damaged length looks like a truncated end, but is followed by whole events.
        find_sync();
        report(start, at_ < file_bytes_
                          ? std::to_string(at_ - start) + " bytes of a damaged event were skipped"
                          : "the last event is cut off (" + std::to_string(file_bytes_ - start) + " bytes)");
        break;
    }
  }
  return false;
}

void EventLogReader::seek(std::uint64_t offset) {
  at_ = std::min(offset, file_bytes_);
  buffer_start_ = at_;
  buffered_ = 0;
}

std::size_t EventLogReader::fill(std::size_t size) {
  const std::size_t skipped = static_cast<std::size_t>(at_ - buffer_start_);
  std::size_t there = skipped <= buffered_ ? buffered_ - skipped : 0;
  if (there >= size) return there;
  if (there > 0) std::memmove(buffer_.data(), buffer_.data() + skipped, there);
  buffer_start_ = at_;
  buffered_ = there;
  if (buffer_.size() < size + read_bytes) buffer_.resize(size + read_bytes);
  // read() may return less than was asked for, and is interrupted by signals.
  while (buffered_ < size) {
    const ssize_t got = ::pread(file_.number(), buffer_.data() + buffered_, buffer_.size() - buffered_,
                                static_cast<off_t>(buffer_start_ + buffered_));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    buffered_ += static_cast<std::size_t>(got);
  }
  return buffered_;
}

EventLogReader::Outcome EventLogReader::read_event(LogEventView& event) {
  const std::uint64_t left = file_bytes_ - at_;
  const std::size_t got = std::min<std::uint64_t>(fill(header_bytes), left);
  const unsigned char* header = here();
  if (got >= 4 && number32(header) != sync_word) return Outcome::garbage;
  if (got < header_bytes) return Outcome::truncated;
  const auto channel_bytes = static_cast<std::int32_t>(number32(header + 20));
  const auto data_bytes = static_cast<std::int32_t>(number32(header + 24));
  if (channel_bytes < 1 || channel_bytes > max_channel_bytes || data_bytes < 0) return Outcome::garbage;
  const std::size_t size =
      header_bytes + static_cast<std::size_t>(channel_bytes) + static_cast<std::size_t>(data_bytes);
  if (size > left || fill(size) < size) return Outcome::truncated;
  header = here();  // fill() may have moved it
  const auto* body = reinterpret_cast<const std::byte*>(header + header_bytes);
  event.number = static_cast<std::int64_t>(number64(header + 4));
  event.utime = static_cast<std::int64_t>(number64(header + 12));
  event.offset = at_;
  event.channel = {reinterpret_cast<const char*>(body), static_cast<std::size_t>(channel_bytes)};
  event.payload = {body + channel_bytes, static_cast<std::size_t>(data_bytes)};
  at_ += size;
  return Outcome::event;
}

void EventLogReader::find_sync() {
  for (++at_; at_ < file_bytes_; ++at_) {
    if (fill(4) < 4) break;
    if (number32(here()) == sync_word) return;
  }
  at_ = file_bytes_;
}

bool EventLogWriter::write(std::int64_t number, std::int64_t utime, std::string_view channel,
                           std::span<const std::byte> payload) {
  std::byte* to = room(header_bytes + channel.size() + payload.size());
  if (to == nullptr) return false;
  const auto put = [&to](const void* from, std::size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
    to += bytes;
  };
  // Numbers of an event are big-endian, as in liblcm's eventlog.c.
  const auto put32 = [&put](std::size_t value) {
    const std::uint32_t ordered = htobe32(static_cast<std::uint32_t>(value));
    put(&ordered, sizeof ordered);
  };
  const auto put64 = [&put](std::int64_t value) {
    const std::uint64_t ordered = htobe64(static_cast<std::uint64_t>(value));
    put(&ordered, sizeof ordered);
  };
  put32(sync_word);
  put64(number);
  put64(utime);
  put32(channel.size());
  put32(payload.size());
  put(channel.data(), channel.size());
  put(payload.data(), payload.size());
  return true;
}

bool EventLogWriter::write(std::span<const std::byte> bytes) {
  std::byte* to = room(bytes.size());
  if (to == nullptr) return false;
  if (!bytes.empty()) std::memcpy(to, bytes.data(), bytes.size());
  return true;
}

std::byte* EventLogWriter::room(std::size_t size) {
  if (block_.used + size > block_bytes && !hand_over()) return nullptr;
  const std::size_t begin = block_.used;
  if (block_.bytes.size() < begin + size) block_.bytes.resize(std::max(block_bytes, begin + size));
  block_.used += size;
  return block_.bytes.data() + begin;
}

bool EventLogWriter::hand_over() {
  return block_.used == 0 || file_.hand_over(block_);
}

bool EventLogWriter::flush() {
  return hand_over() && file_.finish();
}

namespace {

/// Difference of two stamps, which may be anywhere in the range of their type, s.
double difference_s(std::int64_t later, std::int64_t earlier) {
  return 1e-6 * static_cast<double>(static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(earlier));
}

}  // namespace

void TimeOrder::add(std::int64_t utime, std::string_view channel) {
  if (events_++ == 0) last_ = earliest_ = latest_ = utime;
  if (utime < last_ && back_++ == 0) {
    first_event_ = events_;
    first_back_s_ = difference_s(last_, utime);
    first_channel_ = channel;
  }
  last_ = utime;
  earliest_ = std::min(earliest_, utime);
  latest_ = std::max(latest_, utime);
}

std::optional<std::string> TimeOrder::problem() const {
  if (back_ == 0) return std::nullopt;
  return fmt::format(
      "time goes back {}by {:.6g} s at event {} (channel '{}'): several logs in one, or a clock that was "
      "set back",
      back_ == 1 ? "" : fmt::format("{} times, first ", back_), first_back_s_, first_event_,
      sim::printable(sim::shortened(first_channel_)));
}

double TimeOrder::span_s() const {
  return difference_s(latest_, earliest_);
}

}  // namespace bridges
