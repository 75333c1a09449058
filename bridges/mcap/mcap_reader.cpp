// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_reader.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <memory>

#include "bridges/base/bus_error.hpp"

namespace bridges::mcap {
namespace {

constexpr std::size_t max_reader_problems = 100;
constexpr std::size_t decompressed_at_once = std::size_t{1} << 17;
constexpr std::size_t attachment_crc_bytes = 4;

std::uint32_t crc_after(std::uint32_t crc, std::span<const std::byte> data) {  // of less than 4 GB
  return static_cast<std::uint32_t>(
      crc32(crc, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size())));
}

std::uint64_t length_of(std::span<const std::byte> head) {
  RecordParser in(head);
  in.number<std::uint8_t>();
  return in.number<std::uint64_t>();
}

std::size_t bytes_of(const Schema& schema) {
  return schema.name.size() + schema.encoding.size() + schema.text.size();
}

std::size_t bytes_of(const Channel& channel) {
  constexpr std::size_t entry_bytes = 64;  // of the map itself
  std::size_t bytes = channel.topic.size() + channel.encoding.size();
  for (const auto& [key, value] : channel.metadata) bytes += key.size() + value.size() + entry_bytes;
  return bytes;
}

}  // namespace

McapReader::McapReader(const std::string& path)
    : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {  // do not block on a pipe
  if (file_.number() < 0) throw BusError(path + ": " + std::strerror(errno));
  struct stat status {};
  if (fstat(file_.number(), &status) != 0) throw BusError(path + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw BusError(path + ": is not a regular file");
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  std::vector<std::byte> start;
  const bool is_mcap = read_at(0, magic.size(), start) && std::memcmp(start.data(), magic.data(), magic.size()) == 0;
  if (!is_mcap) throw BusError(path + ": is not an MCAP file");
  crc_ = crc_after(0, start);
  at_ = magic.size();
}

void McapReader::report(const std::string& what) {
  if (problems_.size() < max_reader_problems) problems_.push_back("byte " + std::to_string(record_at_) + ": " + what);
}

bool McapReader::read_at(std::uint64_t offset, std::size_t size, std::vector<std::byte>& to) const {
  to.resize(size);
  for (std::size_t done = 0; done < size;) {
    const ssize_t got = ::pread(file_.number(), to.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

McapReader::Item McapReader::next() {
  Item item = Item::end;
  while (true) {
    if (chunk_at_ < chunk_.size()) {
      if (read_in_chunk(item)) return item;
    } else if (ended_) {
      return Item::end;
    } else if (read_record(item)) {
      return item;
    }
  }
}

bool McapReader::read_record(Item& item) {
  record_at_ = at_;
  std::vector<std::byte> head;
  const std::uint64_t left = file_bytes_ - at_;
  if (left < record_head_bytes || !read_at(at_, record_head_bytes, head)) {
    ended_ = true;
    report("the file is cut off");
    return false;
  }
  const auto opcode = static_cast<Opcode>(head[0]);
  const std::uint64_t length = length_of(head);
  const bool cut = length > left - record_head_bytes;
  ended_ = cut || length > max_record_bytes;
  if (cut) report("the file is cut off");
  if (!cut && ended_) report("a record of " + std::to_string(length) + " bytes is too large");
  if (ended_ && (!cut || opcode != Opcode::chunk)) return false;
  // Read the record, of a chunk that is cut off what there is.
  const std::uint64_t size = std::min(length, left - record_head_bytes);
  if (size > max_record_bytes || !read_at(at_ + record_head_bytes, static_cast<std::size_t>(size), record_)) {
    ended_ = true;
    return false;
  }
  at_ += record_head_bytes + size;
  if (opcode == Opcode::chunk) open_chunk(record_, cut);
  const bool read = opcode != Opcode::chunk && use(opcode, record_, item);
  crc_ = crc_after(crc_after(crc_, head), record_);
  return read;
}

void McapReader::open_chunk(std::span<const std::byte> content, bool cut) {
  RecordParser in(content);
  in.number<std::uint64_t>();  // first and last time
  in.number<std::uint64_t>();
  const auto raw_bytes = in.number<std::uint64_t>();
  const auto crc = in.number<std::uint32_t>();
  const std::string compression = in.text();
  const auto size = in.number<std::uint64_t>();
  const std::span<const std::byte> data = cut ? in.rest() : in.bytes(size);
  chunk_.clear();
  chunk_at_ = 0;
  if (!in.ok() || raw_bytes > max_record_bytes) {
    if (!cut) report("invalid chunk");
  } else if (compression == "zstd") {
    if (!inflate(data, raw_bytes) && !cut) report("the compressed data of a chunk are damaged");
  } else if (compression.empty()) {
    chunk_.assign(data.begin(), data.end());
  } else {
    report("compression '" + compression.substr(0, 20) + "' is not supported");
  }
  if (!cut && crc != 0 && crc_after(0, chunk_) != crc) report("the checksum of a chunk is wrong");
}

bool McapReader::inflate(std::span<const std::byte> data, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  ZSTD_inBuffer in{data.data(), data.size(), 0};
  std::size_t used = 0;
  while (used < size) {
    // The memory grows with the data, for the size may be wrong.
    chunk_.resize(std::min<std::size_t>(static_cast<std::size_t>(size), used + decompressed_at_once));
    ZSTD_outBuffer out{chunk_.data(), chunk_.size(), used};
    const std::size_t result = ZSTD_decompressStream(stream.get(), &out, &in);
    const bool more = out.pos > used || in.pos < in.size;
    used = out.pos;
    if (ZSTD_isError(result) != 0 || !more) break;
  }
  chunk_.resize(used);
  return used == size;
}

bool McapReader::read_in_chunk(Item& item) {
  const std::span<const std::byte> left = std::span(chunk_).subspan(chunk_at_);
  const std::uint64_t length = left.size() < record_head_bytes ? 0 : length_of(left);
  if (left.size() < record_head_bytes || length > left.size() - record_head_bytes) {
    if (!ended_) report("a record ends behind its chunk");
    chunk_at_ = chunk_.size();
    return false;
  }
  chunk_at_ += record_head_bytes + static_cast<std::size_t>(length);
  const auto opcode = static_cast<Opcode>(left[0]);
  // Other records may not stand in a chunk (MCAP specification, Chunk).
  const bool allowed = opcode == Opcode::schema || opcode == Opcode::channel || opcode == Opcode::message;
  return allowed && use(opcode, left.subspan(record_head_bytes, static_cast<std::size_t>(length)), item);
}

bool McapReader::use(Opcode opcode, std::span<const std::byte> content, Item& item) {
  RecordParser in(content);
  switch (opcode) {
    case Opcode::header:
      profile_ = in.text();
      return false;
    case Opcode::schema:
      use_schema(in);
      return false;
    case Opcode::channel:
      use_channel(in);
      return false;
    case Opcode::message:
      item = Item::message;
      return use_message(in);
    case Opcode::attachment:
      item = Item::attachment;
      return use_attachment(content);
    case Opcode::metadata:
      item = Item::metadata;
      metadata_.name = in.text();
      metadata_.entries = in.map();
      if (!in.ok()) report("invalid metadata");
      return in.ok();
    case Opcode::data_end:
      end_data(in);
      return false;
    default:
      return false;  // indexes, and records of later versions
  }
}

bool McapReader::keep(std::size_t bytes, std::size_t before) {
  kept_bytes_ += bytes - before;
  if (kept_bytes_ <= max_kept_bytes) return true;
  report("its schemas and channels have more than " + std::to_string(max_kept_bytes >> 20) + " MB together");
  ended_ = true;
  chunk_.clear();
  chunk_at_ = 0;
  return false;
}

void McapReader::use_schema(RecordParser& in) {
  const auto number = in.number<std::uint16_t>();
  Schema schema{in.text(), in.text(), in.text()};
  if (!in.ok() || number == 0) return report("invalid schema");
  Schema& kept = schemas_[number];
  if (keep(bytes_of(schema), bytes_of(kept))) kept = std::move(schema);
}

void McapReader::use_channel(RecordParser& in) {
  const auto number = in.number<std::uint16_t>();
  Channel channel;
  channel.schema = in.number<std::uint16_t>();
  channel.topic = in.text();
  channel.encoding = in.text();
  channel.metadata = in.map();
  if (!in.ok() || (channel.schema != 0 && !schemas_.contains(channel.schema))) return report("invalid channel");
  Channel& kept = channels_[number];
  if (keep(bytes_of(channel), bytes_of(kept))) kept = std::move(channel);
}

bool McapReader::use_message(RecordParser& in) {
  message_.channel = in.number<std::uint16_t>();
  message_.sequence = in.number<std::uint32_t>();
  message_.log_time_ns = in.number<std::uint64_t>();
  message_.publish_time_ns = in.number<std::uint64_t>();
  message_.data = in.rest();
  const bool valid = in.ok() && channels_.contains(message_.channel);
  if (!valid) report("a message without its channel");
  return valid;
}

bool McapReader::use_attachment(std::span<const std::byte> content) {
  RecordParser in(content);
  attachment_.log_time_ns = in.number<std::uint64_t>();
  attachment_.create_time_ns = in.number<std::uint64_t>();
  attachment_.name = in.text();
  attachment_.media_type = in.text();
  const std::span<const std::byte> data = in.bytes(in.number<std::uint64_t>());
  attachment_.data.assign(reinterpret_cast<const char*>(data.data()), data.size());
  const auto crc = in.number<std::uint32_t>();
  // 0 means that the writer computed none.
  const bool valid = in.ok() && (crc == 0 || crc_after(0, content.first(content.size() - attachment_crc_bytes)) == crc);
  if (!valid) report("a damaged attachment");
  return valid;
}

void McapReader::end_data(RecordParser& in) {
  ended_ = true;
  const auto crc = in.number<std::uint32_t>();
  if (!in.ok() || (crc != 0 && crc != crc_)) return report("the checksum of the data is wrong");
  std::vector<std::byte> end;
  complete_ = file_bytes_ >= at_ + magic.size() && read_at(file_bytes_ - magic.size(), magic.size(), end) &&
              std::memcmp(end.data(), magic.data(), magic.size()) == 0;
  if (!complete_) report("the file is cut off in its summary");
}

}  // namespace bridges::mcap
