// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/record_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/log/event_log.hpp"
#include "bridges/mcap/mcap_record.hpp"

namespace bridges {
namespace {

/// Bytes of an event header: sync word, number, time, two lengths.
constexpr std::uint64_t event_head_bytes = 28;
constexpr std::size_t copied_at_once = std::size_t{1} << 20;

class LcmRecordFile final : public RecordFile {
 public:
  LcmRecordFile(std::string path, Existing existing)
      : path_(std::move(path)), log_(create_record_file(path_, existing)) {}

  bool write(std::int64_t number, std::int64_t utime, std::string_view channel,
             std::span<const std::byte> payload) override {
    if (!log_.write(number, utime, channel, payload)) return false;
    bytes_ += event_head_bytes + channel.size() + payload.size();
    return true;
  }
  bool hand_over() override { return log_.hand_over(); }
  bool flush() override { return log_.flush(); }
  bool finish() override { return log_.flush(); }
  std::uint64_t position() const override { return bytes_; }

  std::unique_ptr<RecordFile> branch_to(const std::string& path, std::uint64_t position, Existing existing) override {
    auto next = std::make_unique<LcmRecordFile>(path, existing);
    const FileDescriptor from(open(path_.c_str(), O_RDONLY | O_CLOEXEC));
    std::vector<std::byte> part(copied_at_once);
    std::uint64_t left = position;
    if (from.number() < 0) return nullptr;
    while (left > 0) {
      const ssize_t got = ::read(from.number(), part.data(), std::min<std::uint64_t>(left, part.size()));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0 || !next->log_.write({part.data(), static_cast<std::size_t>(got)})) return nullptr;
      left -= static_cast<std::uint64_t>(got);
    }
    next->bytes_ = position;
    return next->log_.flush() ? std::move(next) : nullptr;  // a full disk is detected here
  }

 private:
  std::string path_;
  EventLogWriter log_;
  std::uint64_t bytes_ = 0;
};

/// A position is a number of messages: chunks are compressed, and end at other places in a branch.
class McapRecordFile final : public RecordFile {
 public:
  McapRecordFile(std::string path, Existing existing)
      : path_(std::move(path)), record_(std::make_unique<mcap::McapRecord>(create_record_file(path_, existing))) {}
  McapRecordFile(std::string path, std::unique_ptr<mcap::McapRecord> record)
      : path_(std::move(path)), record_(std::move(record)) {}

  bool write(std::int64_t, std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) override {
    return record_->write(utime, channel, payload);
  }
  /// A chunk that ended is written at once, and the end of a chunk depends on the messages only.
  bool hand_over() override { return true; }
  bool flush() override { return record_->flush(); }
  bool finish() override { return record_->finish(); }
  std::uint64_t position() const override { return record_->file().messages(); }
  std::vector<std::string> problems() const override { return record_->problems(); }

  std::unique_ptr<RecordFile> branch_to(const std::string& path, std::uint64_t position, Existing existing) override {
    auto next = record_->branch(path_, position, create_record_file(path, existing));
    return next ? std::make_unique<McapRecordFile>(path, std::move(next)) : nullptr;
  }

 private:
  std::string path_;
  std::unique_ptr<mcap::McapRecord> record_;
};

}  // namespace

FileDescriptor create_record_file(const std::string& path, Existing existing) {
  // O_EXCL checks and creates atomically; a device such as /dev/full is never created.
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (existing == Existing::refuse ? O_EXCL : 0);
  FileDescriptor file(open(path.c_str(), flags, 0666));
  if (file.number() < 0 && errno == EEXIST)
    throw BusError(path + ": already exists; choose another name or pass --overwrite");
  if (file.number() < 0) throw BusError(path + ": " + std::strerror(errno));
  // Runs do not mix in a device such as /dev/null.
  struct stat kind = {};
  const bool device = fstat(file.number(), &kind) == 0 && S_ISCHR(kind.st_mode);
  if (const auto owner = device ? std::optional<std::string>() : lock_against_others(file.number()))
    throw BusError(path + ": " + *owner + " is recording into it; choose another name");
  // Truncate only now, to keep the record of another run.  A device has no length.
  if (ftruncate(file.number(), 0) != 0 && errno != EINVAL) throw BusError(path + ": " + std::strerror(errno));
  return file;
}

bool is_mcap_name(std::string_view path) {
  return path.ends_with(".mcap");
}

std::unique_ptr<RecordFile> create_record(const std::string& path, Existing existing) {
  if (is_mcap_name(path)) return std::make_unique<McapRecordFile>(path, existing);
  return std::make_unique<LcmRecordFile>(path, existing);
}

}  // namespace bridges
