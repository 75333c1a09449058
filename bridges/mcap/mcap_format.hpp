// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Format of MCAP files (https://mcap.dev/spec): records of an opcode, a length of 8 bytes and a content, all numbers
/// little-endian, texts and lists with a length of 4 bytes.
namespace bridges::mcap {

/// Opcodes of the records.
enum class Opcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  attachment = 9,
  attachment_index = 10,
  statistics = 11,
  metadata = 12,
  metadata_index = 13,
  summary_offset = 14,
  data_end = 15
};

inline constexpr std::array<std::uint8_t, 8> magic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t record_head_bytes = 9;
/// Content of a message record before its data: channel, number, two times.
inline constexpr std::size_t message_head_bytes = 22;
/// Limit of a chunk, of its content and of any other record.
inline constexpr std::uint64_t max_record_bytes = std::uint64_t{1} << 28;
/// Limit for all schemas and channels together, which a reader keeps: a chunk of some kilobytes can hold hundreds of
/// megabytes.
inline constexpr std::uint64_t max_kept_bytes = std::uint64_t{1} << 26;

using TextMap = std::map<std::string, std::string>;

/// Builder of records in a buffer.
class RecordBuilder {
 public:
  explicit RecordBuilder(std::vector<std::byte>& out) : out_(out) {}

  /// Starts a record; end() sets its length.
  void begin(Opcode opcode) {
    number(static_cast<std::uint8_t>(opcode));
    number(std::uint64_t{0});
    begin_ = out_.size();
  }
  void end() {
    const std::uint64_t length = out_.size() - begin_;
    std::memcpy(out_.data() + begin_ - sizeof length, &length, sizeof length);
  }
  template <class T>
  void number(T value) {
    bytes(std::as_bytes(std::span(&value, 1)));
  }
  void bytes(std::span<const std::byte> data) { out_.insert(out_.end(), data.begin(), data.end()); }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes(std::as_bytes(std::span(value.data(), value.size())));
  }
  void map(const TextMap& map) {
    const std::size_t length_at = out_.size();
    number(std::uint32_t{0});
    for (const auto& [key, value] : map) {
      text(key);
      text(value);
    }
    const auto length = static_cast<std::uint32_t>(out_.size() - length_at - sizeof(std::uint32_t));
    std::memcpy(out_.data() + length_at, &length, sizeof length);
  }
  std::size_t size() const { return out_.size(); }

 private:
  std::vector<std::byte>& out_;
  std::size_t begin_ = 0;
};

/// Parser of the content of a record.  After a read beyond its end it is not ok(), and gives zeros and empty texts.
class RecordParser {
 public:
  explicit RecordParser(std::span<const std::byte> content) : left_(content) {}

  template <class T>
  T number() {
    T value{};
    const std::span<const std::byte> data = bytes(sizeof value);
    if (ok_) std::memcpy(&value, data.data(), sizeof value);
    return value;
  }
  std::span<const std::byte> bytes(std::uint64_t size) {
    ok_ = ok_ && size <= left_.size();
    if (!ok_) return {};
    const std::span<const std::byte> taken = left_.first(static_cast<std::size_t>(size));
    left_ = left_.subspan(taken.size());
    return taken;
  }
  std::string text() {
    const std::span<const std::byte> data = bytes(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(data.data()), data.size()};
  }
  TextMap map() {
    RecordParser entries(bytes(number<std::uint32_t>()));
    TextMap map;
    while (ok_ && !entries.left_.empty()) {
      std::string key = entries.text();
      std::string value = entries.text();
      ok_ = entries.ok_;
      if (ok_) map.insert_or_assign(std::move(key), std::move(value));
    }
    return map;
  }
  std::span<const std::byte> rest() const { return left_; }
  bool ok() const { return ok_; }

 private:
  std::span<const std::byte> left_;
  bool ok_ = true;
};

}  // namespace bridges::mcap
