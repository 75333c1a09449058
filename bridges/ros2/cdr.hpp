// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "shoal/message_schema.hpp"

namespace bridges::ros2 {

/// Maximum size of an encoded message.
inline constexpr std::size_t max_cdr_bytes = std::size_t{1} << 28;

/// Transcodes an LCM payload into CDR by its schema, as the type of schema_text().  `out` is replaced.  Returns the
/// error of an invalid payload, or none.
std::optional<std::string> to_cdr(const shoal::MessageSchema& schema, std::span<const std::byte> payload,
                                  std::vector<std::byte>& out);

/// Transcodes CDR of to_cdr(), which may be damaged, back into the LCM payload.  `out` is replaced.  Returns the error
/// of invalid bytes, or none.
std::optional<std::string> from_cdr(const shoal::MessageSchema& schema, std::span<const std::byte> cdr,
                                    std::vector<std::byte>& out);

/// Encoder of XCDR1, little-endian: the wire format of ROS 2 messages.  Numbers are aligned to their size, counted from
/// the end of the 4-byte header.  See OMG DDS-XTypes 1.3, section 7.4.
class CdrWriter {
 public:
  static constexpr std::size_t header_bytes = 4;

  /// Starts a message in `out`, whose memory is reused.  `out` must outlive this.
  explicit CdrWriter(std::vector<std::byte>& out) : out_(out) {
    static_assert(std::endian::native == std::endian::little);
    out_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
  }

  template <class T>
  void put(T value) requires std::is_arithmetic_v<T> {
    align(sizeof value);
    append(&value, sizeof value);
  }
  /// Appends a string: its length with the final NUL, its bytes, and the NUL.
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(text.data(), text.size());
    out_.push_back(std::byte{0});
  }
  /// Appends the count of a sequence, which its elements follow.
  void put_count(std::size_t count) { put(static_cast<std::uint32_t>(count)); }
  /// Appends the elements of an array of fixed size, without a count.
  template <class T>
  void put_array(std::span<const T> values) {
    if (values.empty()) return;
    align(sizeof(T));
    append(values.data(), values.size_bytes());
  }
  /// Appends the count and the elements.
  template <class T>
  void put_sequence(std::span<const T> values) {
    put_count(values.size());
    put_array(values);
  }
  /// Appends space for `count` aligned elements of `size` bytes, and returns it; valid until the next call.
  std::byte* room(std::size_t count, std::size_t size) {
    if (count > 0) align(size);
    const std::size_t begin = out_.size();
    out_.resize(begin + count * size);
    return out_.data() + begin;
  }
  std::size_t size() const { return out_.size(); }

 private:
  void align(std::size_t size) {
    const std::size_t over = (out_.size() - header_bytes) % size;
    if (over != 0) out_.resize(out_.size() + size - over);
  }
  void append(const void* from, std::size_t bytes) {
    if (bytes == 0) return;
    const std::size_t begin = out_.size();
    out_.resize(begin + bytes);
    std::memcpy(out_.data() + begin, from, bytes);
  }

  std::vector<std::byte>& out_;
};

/// Decoder of the same, of bytes that may be anything and must outlive this.  Throws shoal::MessageError where they
/// end, or are not in this encoding.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> cdr) : cdr_(cdr) {
    if (cdr.size() < at_ || cdr[0] != std::byte{0} || cdr[1] != std::byte{1})
      throw shoal::MessageError("must begin with 00 01 (CDR, little-endian)");
  }

  template <class T>
  T get() requires std::is_arithmetic_v<T> {
    const std::size_t over = (at_ - CdrWriter::header_bytes) % sizeof(T);
    const std::span<const std::byte> bytes = next(sizeof(T) + (over == 0 ? 0 : sizeof(T) - over)).last(sizeof(T));
    if constexpr (std::is_same_v<T, bool>) return bytes[0] != std::byte{0};
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  /// Returns a string without its final NUL.
  std::string text() {
    const std::span<const std::byte> bytes = next(get<std::uint32_t>());
    if (!bytes.empty() && bytes.back() != std::byte{0}) throw shoal::MessageError("a string does not end with NUL");
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - (bytes.empty() ? 0 : 1)};
  }
  /// Returns the count of a sequence whose elements have at least this size.
  std::size_t count(std::size_t element_bytes) {
    const std::size_t count = get<std::uint32_t>();
    if (count > (cdr_.size() - at_) / element_bytes) throw shoal::MessageError("a sequence is longer than the message");
    return count;
  }
  /// Returns an array of fixed size, such as geometry_msgs/Vector3.
  template <class T, std::size_t size>
  std::array<T, size> array() {
    std::array<T, size> values{};
    for (T& value : values) value = get<T>();
    return values;
  }

 private:
  std::span<const std::byte> next(std::size_t bytes) {
    if (bytes > cdr_.size() - at_) throw shoal::MessageError("ends too early");
    const auto found = cdr_.subspan(at_, bytes);
    at_ += bytes;
    return found;
  }

  std::span<const std::byte> cdr_;
  std::size_t at_ = CdrWriter::header_bytes;
};

}  // namespace bridges::ros2
