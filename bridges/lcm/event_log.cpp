#include "bridges/lcm/event_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace bridges {
namespace {

// Per event, big-endian: sync word, number (8), time (8), length of the channel (4), of the data (4).
constexpr std::uint32_t sync_word = 0xEDA1DA01;
constexpr std::size_t header_bytes = 28;
constexpr std::int32_t max_channel_bytes = 1000;  // liblcm's own limit for logs
constexpr std::size_t max_problems = 100;
constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
constexpr std::size_t read_bytes = std::size_t{1} << 17;

template <class T>
T big_endian(const unsigned char* at) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8 | at[i]);
  return value;
}

template <class T>
std::byte* put_big_endian(std::byte* to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) *to++ = static_cast<std::byte>(value >> 8 * (sizeof(T) - 1 - i));
  return to;
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

EventLogReader::EventLogReader(const std::string& path) : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (file_.number() < 0) throw BusError(path + ": " + std::strerror(errno));
  struct stat status {};
  if (fstat(file_.number(), &status) != 0) throw BusError(path + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw BusError(path + ": is no regular file");
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
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
  while (at_ < file_bytes_) {
    const std::uint64_t start = at_;
    switch (read_event(event)) {
      case Outcome::event:
        return true;
      case Outcome::garbage:
        find_sync();
        report(start, std::to_string(at_ - start) + " bytes that are no event were skipped");
        break;
      case Outcome::truncated:
        // A damaged length looks the same as a cut end; then whole events follow.
        find_sync();
        report(start, at_ < file_bytes_
                          ? std::to_string(at_ - start) + " bytes of a damaged event were skipped"
                          : "the last event is cut off (" + std::to_string(file_bytes_ - start) + " bytes)");
        break;
    }
  }
  return false;
}

std::size_t EventLogReader::fill(std::size_t size) {
  const std::size_t skipped = static_cast<std::size_t>(at_ - buffer_begin_);
  std::size_t there = skipped <= buffered_ ? buffered_ - skipped : 0;
  if (there >= size) return there;
  if (there > 0) std::memmove(buffer_.data(), buffer_.data() + skipped, there);
  buffer_begin_ = at_;
  buffered_ = there;
  if (buffer_.size() < size + read_bytes) buffer_.resize(size + read_bytes);
  while (buffered_ < size) {
    const ssize_t got = ::pread(file_.number(), buffer_.data() + buffered_, buffer_.size() - buffered_,
                                static_cast<off_t>(buffer_begin_ + buffered_));
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
  if (got >= 4 && big_endian<std::uint32_t>(header) != sync_word) return Outcome::garbage;
  if (got < header_bytes) return Outcome::truncated;
  const auto channel_bytes = static_cast<std::int32_t>(big_endian<std::uint32_t>(header + 20));
  const auto data_bytes = static_cast<std::int32_t>(big_endian<std::uint32_t>(header + 24));
  if (channel_bytes < 1 || channel_bytes > max_channel_bytes || data_bytes < 0) return Outcome::garbage;
  const std::size_t size =
      header_bytes + static_cast<std::size_t>(channel_bytes) + static_cast<std::size_t>(data_bytes);
  if (size > left || fill(size) < size) return Outcome::truncated;
  header = here();  // fill() may have moved it
  const auto* body = reinterpret_cast<const std::byte*>(header + header_bytes);
  event.number = static_cast<std::int64_t>(big_endian<std::uint64_t>(header + 4));
  event.utime = static_cast<std::int64_t>(big_endian<std::uint64_t>(header + 12));
  event.offset = at_;
  event.channel = {reinterpret_cast<const char*>(body), static_cast<std::size_t>(channel_bytes)};
  event.payload = {body + channel_bytes, static_cast<std::size_t>(data_bytes)};
  at_ += size;
  return Outcome::event;
}

void EventLogReader::find_sync() {
  for (++at_; at_ < file_bytes_; ++at_) {
    if (fill(4) < 4) break;
    if (big_endian<std::uint32_t>(here()) == sync_word) return;
  }
  at_ = file_bytes_;
}

bool EventLogWriter::write(std::int64_t number, std::int64_t utime, std::string_view channel,
                           std::span<const std::byte> payload) {
  const std::size_t size = header_bytes + channel.size() + payload.size();
  if (buffer_.size() + size > buffer_bytes && !flush()) return false;
  buffer_.reserve(std::max(buffer_bytes, size));
  std::array<std::byte, header_bytes> header;
  std::byte* to = put_big_endian(header.data(), sync_word);
  to = put_big_endian(to, static_cast<std::uint64_t>(number));
  to = put_big_endian(to, static_cast<std::uint64_t>(utime));
  to = put_big_endian(to, static_cast<std::uint32_t>(channel.size()));
  put_big_endian(to, static_cast<std::uint32_t>(payload.size()));
  const auto name = std::as_bytes(std::span(channel));
  buffer_.insert(buffer_.end(), header.begin(), header.end());
  buffer_.insert(buffer_.end(), name.begin(), name.end());
  buffer_.insert(buffer_.end(), payload.begin(), payload.end());
  return true;
}

bool EventLogWriter::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file_.number(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

bool EventLogWriter::flush() {
  const bool done = write(buffer_);
  buffer_.clear();
  return done;
}

}  // namespace bridges
