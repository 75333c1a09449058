// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/cdr.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace bridges::ros2 {
namespace {

using shoal::Member;
using shoal::WireType;

/// Traversal of a valid payload, whose lengths need no further check.
class Transcoder {
 public:
  Transcoder(std::span<const std::byte> payload, CdrWriter& out)
      : at_(payload.data() + sizeof(std::uint64_t)), out_(out) {}

  /// Returns false when the output is too large.
  bool transcode(const shoal::MessageSchema& schema) {
    if (schema.members.empty()) out_.put(std::uint8_t{0});  // only_member
    std::vector<std::int64_t> lengths(static_cast<std::size_t>(schema.length_slots));
    return std::all_of(schema.members.begin(), schema.members.end(),
                       [&](const Member& member) { return transcode(member, lengths); });
  }

 private:
  bool transcode(const Member& member, std::vector<std::int64_t>& lengths) {
    std::size_t count = 1;
    for (const shoal::Dimension& dimension : member.dimensions)
      count *= static_cast<std::size_t>(
          dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)] : dimension.constant);
    // An LCM array of variable size is a CDR sequence, which begins with its count; a fixed one has none in either.
    if (member.is_variable()) out_.put_count(count);
    if (member.type == WireType::compound) {
      for (std::size_t i = 0; i < count; ++i)
        if (!transcode(*member.compound)) return false;
    } else if (member.type == WireType::string) {
      for (std::size_t i = 0; i < count; ++i) copy_string();
    } else {
      const std::size_t size = shoal::wire_size(member.type);
      if (member.length_slot >= 0) lengths[static_cast<std::size_t>(member.length_slot)] = integer(size);
      copy_numbers(member.type, count, size);
    }
    return out_.size() <= max_cdr_bytes;
  }

  /// Reads the length of an array, an integer of any size.
  std::int64_t integer(std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | std::to_integer<std::uint64_t>(at_[i]);
    const unsigned unused = static_cast<unsigned>(64 - 8 * size);
    return static_cast<std::int64_t>(value << unused) >> unused;
  }

  /// Both formats store a string as its length with the final NUL, and its bytes.
  void copy_string() {
    const auto size = static_cast<std::size_t>(integer(4));
    out_.put(std::string_view(reinterpret_cast<const char*>(at_ + 4), size - 1));
    at_ += 4 + size;
  }

  /// Reverses the bytes of each number: LCM is big-endian.
  void copy_numbers(WireType type, std::size_t count, std::size_t size) {
    std::byte* to = out_.room(count, size);
    if (type == WireType::boolean)
      std::transform(at_, at_ + count, to, [](std::byte b) { return b == std::byte{0} ? b : std::byte{1}; });
    else if (size == 1)
      std::copy_n(at_, count, to);
    else if (size == 2)
      swap_all<std::uint16_t>(to, count);
    else if (size == 4)
      swap_all<std::uint32_t>(to, count);
    else
      swap_all<std::uint64_t>(to, count);
    at_ += count * size;
  }

  template <class T>
  void swap_all(std::byte* to, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      T value;
      std::memcpy(&value, at_ + i * sizeof value, sizeof value);
      if constexpr (sizeof value == 2)
        value = __builtin_bswap16(value);
      else if constexpr (sizeof value == 4)
        value = __builtin_bswap32(value);
      else
        value = __builtin_bswap64(value);
      std::memcpy(to + i * sizeof value, &value, sizeof value);
    }
  }

  const std::byte* at_;
  CdrWriter& out_;
};

/// Traversal of CDR, whose bytes may be anything.  Every function returns false where they end or contradict the
/// schema.
class BackTranscoder {
 public:
  BackTranscoder(std::span<const std::byte> cdr, std::vector<std::byte>& out) : cdr_(cdr), out_(out) {}

  bool transcode(const shoal::MessageSchema& schema) {
    if (schema.members.empty() && !has(1)) return false;
    if (schema.members.empty()) ++at_;  // only_member
    std::vector<std::uint64_t> lengths(static_cast<std::size_t>(schema.length_slots));
    return std::all_of(schema.members.begin(), schema.members.end(),
                       [&](const Member& member) { return transcode(member, lengths); });
  }
  bool at_end() const { return at_ == cdr_.size(); }

 private:
  bool has(std::size_t bytes) const { return bytes <= cdr_.size() - at_; }

  /// Skips the padding before a number, which is aligned to its size after the header.
  bool align(std::size_t size) {
    const std::size_t over = (at_ - CdrWriter::header_bytes) % size;
    if (over == 0) return true;
    if (!has(size - over)) return false;
    at_ += size - over;
    return true;
  }

  /// Reads the count of a sequence, or the length of a string.
  bool read_count(std::size_t& count) {
    std::uint32_t value = 0;
    if (!align(sizeof value) || !has(sizeof value)) return false;
    std::memcpy(&value, cdr_.data() + at_, sizeof value);
    at_ += sizeof value;
    count = value;
    return has(count);  // each element has a byte at least
  }

  bool transcode(const Member& member, std::vector<std::uint64_t>& lengths) {
    std::size_t count = 1;
    for (const shoal::Dimension& dimension : member.dimensions) {
      const std::uint64_t size = dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)]
                                                         : static_cast<std::uint64_t>(dimension.constant);
      // The lengths come from the payload. No array can have more elements than the whole payload has bytes, so this
      // bounds the loops and keeps the product from overflowing.
      if (size > cdr_.size() || count > cdr_.size()) return false;
      count *= size;
    }
    if (std::size_t noted = 0; member.is_variable() && (!read_count(noted) || noted != count)) return false;
    if (member.type == WireType::compound || member.type == WireType::string) {
      for (std::size_t i = 0; i < count; ++i)
        if (!(member.type == WireType::string ? copy_string() : transcode(*member.compound))) return false;
      return true;
    }
    const std::size_t size = shoal::wire_size(member.type);
    if (count == 0) return true;
    if (!align(size) || !has(count) || !has(count * size)) return false;
    if (member.length_slot >= 0) lengths[static_cast<std::size_t>(member.length_slot)] = integer(size);
    // LCM is big-endian and CDR is little-endian: the bytes of each element are reversed.
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = cdr_.begin() + static_cast<std::ptrdiff_t>(at_);
      out_.insert(out_.end(), std::make_reverse_iterator(first + static_cast<std::ptrdiff_t>(size)),
                  std::make_reverse_iterator(first));
      at_ += size;
    }
    return true;
  }

  /// Returns a length, which is not negative in a valid message.
  std::uint64_t integer(std::size_t size) const {
    std::uint64_t value = 0;
    std::memcpy(&value, cdr_.data() + at_, size);
    return value;
  }

  bool copy_string() {
    std::size_t size = 0;
    if (!read_count(size)) return false;
    for (int shift = 24; shift >= 0; shift -= 8) out_.push_back(static_cast<std::byte>(size >> shift & 0xff));
    const auto first = cdr_.begin() + static_cast<std::ptrdiff_t>(at_);
    out_.insert(out_.end(), first, first + static_cast<std::ptrdiff_t>(size));
    at_ += size;
    return true;
  }

  std::span<const std::byte> cdr_;
  std::vector<std::byte>& out_;
  std::size_t at_ = CdrWriter::header_bytes;
};

}  // namespace

std::optional<std::string> to_cdr(const shoal::MessageSchema& schema, std::span<const std::byte> payload,
                                  std::vector<std::byte>& out) {
  out.clear();
  if (auto error = shoal::validate(schema, payload, shoal::Finite::any)) return error;
  CdrWriter writer(out);
  if (Transcoder(payload, writer).transcode(schema)) return std::nullopt;
  out.clear();
  return schema.name + " is larger than " + std::to_string(max_cdr_bytes) + " bytes in CDR";
}

std::optional<std::string> from_cdr(const shoal::MessageSchema& schema, std::span<const std::byte> cdr,
                                    std::vector<std::byte>& out) {
  out.clear();
  constexpr std::byte header[] = {std::byte{0}, std::byte{1}};  // XCDR1, little-endian
  if (cdr.size() < CdrWriter::header_bytes || !std::equal(std::begin(header), std::end(header), cdr.begin()))
    return schema.name + ": not in CDR";
  for (int shift = 56; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::byte>(schema.fingerprint >> shift & 0xff));
  BackTranscoder reader(cdr, out);
  std::optional<std::string> error;
  if (!reader.transcode(schema) || !reader.at_end())
    error = schema.name + ": its CDR does not have the members of the type";
  else
    error = shoal::validate(schema, out, shoal::Finite::any);
  if (error) out.clear();
  return error;
}

}  // namespace bridges::ros2
