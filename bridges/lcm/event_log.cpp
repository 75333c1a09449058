#include "bridges/lcm/event_log.hpp"

#include <sys/stat.h>

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

template <class T>
T big_endian(const unsigned char* at) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8 | at[i]);
  return value;
}

}  // namespace

EventLogReader::EventLogReader(const std::string& path) : file_(std::fopen(path.c_str(), "rbe")) {
  if (!file_) throw BusError(path + ": " + std::strerror(errno));
  struct stat status {};
  if (fstat(fileno(file_.get()), &status) != 0) throw BusError(path + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw BusError(path + ": is no regular file");
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  std::setvbuf(file_.get(), buffer_.data(), _IOFBF, buffer_.size());
}

std::optional<LogEvent> EventLogReader::next() {
  LogEvent event;
  if (!next(event)) return std::nullopt;
  return event;
}

bool EventLogReader::next(LogEvent& event) {
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

EventLogReader::Outcome EventLogReader::read_event(LogEvent& event) {
  std::array<unsigned char, header_bytes> header;
  const std::uint64_t left = file_bytes_ - at_;
  const std::size_t got = fread_unlocked(header.data(), 1, std::min<std::uint64_t>(header_bytes, left), file_.get());
  if (got >= 4 && big_endian<std::uint32_t>(header.data()) != sync_word) return Outcome::garbage;
  if (got < header_bytes) return Outcome::truncated;
  const auto channel_bytes = static_cast<std::int32_t>(big_endian<std::uint32_t>(&header[20]));
  const auto data_bytes = static_cast<std::int32_t>(big_endian<std::uint32_t>(&header[24]));
  if (channel_bytes < 1 || channel_bytes > max_channel_bytes || data_bytes < 0) return Outcome::garbage;
  const auto body = static_cast<std::uint64_t>(channel_bytes) + static_cast<std::uint64_t>(data_bytes);
  if (body > left - header_bytes) return Outcome::truncated;
  event.number = static_cast<std::int64_t>(big_endian<std::uint64_t>(&header[4]));
  event.utime = static_cast<std::int64_t>(big_endian<std::uint64_t>(&header[12]));
  event.offset = at_;
  event.channel.resize(static_cast<std::size_t>(channel_bytes));
  event.payload.resize(static_cast<std::size_t>(data_bytes));
  if (fread_unlocked(event.channel.data(), 1, event.channel.size(), file_.get()) != event.channel.size() ||
      fread_unlocked(event.payload.data(), 1, event.payload.size(), file_.get()) != event.payload.size())
    return Outcome::truncated;
  at_ += header_bytes + body;
  return Outcome::event;
}

void EventLogReader::find_sync() {
  std::uint64_t offset = at_ + 1;
  at_ = file_bytes_;
  if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) return;
  std::uint32_t window = 0;
  std::size_t seen = 0;
  for (int c = std::getc(file_.get()); c != EOF; c = std::getc(file_.get())) {
    window = window << 8 | static_cast<std::uint32_t>(c);
    ++offset;
    if (++seen < 4 || window != sync_word) continue;
    at_ = offset - 4;
    fseeko(file_.get(), static_cast<off_t>(at_), SEEK_SET);
    return;
  }
}

}  // namespace bridges
