// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/message_frame.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "bridges/base/json_text.hpp"
#include "shoal/wire_value.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;
using shoal::WireType;

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

constexpr std::size_t head_bytes = 32, header_bytes_at = 4, time_at = 8, alignment = 8;
constexpr std::uint8_t message_kind = 2;
/// Longer arrays of numbers are in the blob.
constexpr std::uint64_t longest_in_header = 16;

Json number_at(WireType type, const std::byte* at) {
  if (type == WireType::boolean) return *at == std::byte{0} ? 0 : 1;
  if (type != WireType::float32 && type != WireType::float64) return shoal::read_integer(type, at);
  const double value = shoal::read_real(type, at);
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void pad(std::string& bytes, char with) {
  bytes.resize((bytes.size() + alignment - 1) / alignment * alignment, with);
}

/// Decoding of a payload that validate() has accepted, into JSON and a blob.
class FieldDecoder {
 public:
  explicit FieldDecoder(std::span<const std::byte> payload) : at_(payload.data() + sizeof(std::uint64_t)) {}

  Json decode(const shoal::MessageSchema& schema) {
    Json fields = Json::object();
    Lengths lengths{};
    for (const shoal::Member& member : schema.members) fields[member.name] = decode_member(member, lengths);
    return fields;
  }
  std::string take_blob() { return std::move(blob_); }

 private:
  using Lengths = std::array<std::int64_t, 64>;
  using Sizes = std::vector<std::uint64_t>;

  Json decode_member(const shoal::Member& member, Lengths& lengths) {
    Sizes sizes;
    std::uint64_t count = 1;
    for (const shoal::Dimension& dimension : member.dimensions) {
      sizes.push_back(static_cast<std::uint64_t>(
          dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)] : dimension.constant));
      count *= sizes.back();
    }
    if (member.length_slot >= 0)
      lengths[static_cast<std::size_t>(member.length_slot)] = shoal::read_integer(member.type, at_);
    const bool is_number = member.type != WireType::compound && member.type != WireType::string;
    // Long arrays go into the binary part: as JSON they would take several times the bytes and time.
    if (is_number && !sizes.empty() && count > longest_in_header) return put_array(member.type, sizes, count);
    return decode_elements(member, sizes, 0);
  }

  Json decode_elements(const shoal::Member& member, const Sizes& sizes, std::size_t dimension) {
    if (dimension == sizes.size()) return decode_element(member);
    Json list = Json::array();
    for (std::uint64_t i = 0; i < sizes[dimension]; ++i) list.push_back(decode_elements(member, sizes, dimension + 1));
    return list;
  }

  Json decode_element(const shoal::Member& member) {
    if (member.type == WireType::compound) return decode(*member.compound);
    if (member.type == WireType::string) {
      const std::size_t size = shoal::big_endian<std::uint32_t>(at_);  // with the final NUL
      std::string text(reinterpret_cast<const char*>(at_ + 4), size - 1);
      at_ += 4 + size;
      return text;
    }
    Json number = number_at(member.type, at_);
    at_ += shoal::wire_size(member.type);
    return number;
  }

  /// Puts an array into the blob, and returns its place.  One of several dimensions has its sizes as "shape".
  Json put_array(WireType type, const Sizes& sizes, std::uint64_t count) {
    pad(blob_, '\0');
    Json place{{"offset", blob_.size()}, {"count", count}};
    if (sizes.size() > 1) place["shape"] = sizes;
    const std::size_t size = shoal::wire_size(type);
    if (type == WireType::float32) {
      place["array"] = "f32";
      put_numbers(count, size, [](const std::byte* at) { return shoal::big_endian<std::uint32_t>(at); });
    } else if (type == WireType::float64) {
      place["array"] = "f64";
      put_numbers(count, size, [](const std::byte* at) { return shoal::big_endian<std::uint64_t>(at); });
    } else if (type == WireType::byte || type == WireType::boolean) {
      place["array"] = "u8";
      blob_.append(reinterpret_cast<const char*>(at_), count);
      at_ += count;
    } else {
      place["array"] = "i64";
      put_numbers(count, size, [type](const std::byte* at) { return shoal::read_integer(type, at); });
    }
    return place;
  }

  template <typename Read>
  void put_numbers(std::uint64_t count, std::size_t size, const Read& read) {
    using Number = decltype(read(at_));
    std::size_t to = blob_.size();
    blob_.resize(to + count * sizeof(Number));
    for (std::uint64_t i = 0; i < count; ++i, at_ += size, to += sizeof(Number)) {
      const Number number = read(at_);
      std::memcpy(blob_.data() + to, &number, sizeof number);
    }
  }

  const std::byte* at_;
  std::string blob_;
};

}  // namespace

std::string message_frame(const shoal::MessageTypes& types, std::string_view channel,
                          std::span<const std::byte> payload, std::int64_t time_us) {
  // All fields that can be read
  const shoal::MessageSchema* schema = payload.size() < sizeof(std::uint64_t)
                                           ? nullptr
                                           : types.find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  Json header{{"channel", channel}, {"type", schema == nullptr ? "" : schema->name}, {"fields", Json::object()}};
  std::string blob;
  const bool is_shown = schema != nullptr && payload.size() <= max_shown_payload &&
                        !shoal::validate(*schema, payload, shoal::Finite::any);
  if (is_shown) {
    FieldDecoder decoder(payload);
    header["fields"] = decoder.decode(*schema);
    blob = decoder.take_blob();
  } else {
    header["bytes"] = payload.size();
  }

  // Head, header, blob
  std::string text = bridges::json_text(header);
  pad(text, ' ');
  std::string frame(head_bytes, '\0');
  frame[0] = static_cast<char>(message_kind);
  const auto header_bytes = static_cast<std::uint32_t>(text.size());
  std::memcpy(frame.data() + header_bytes_at, &header_bytes, sizeof header_bytes);
  std::memcpy(frame.data() + time_at, &time_us, sizeof time_us);
  frame += text;
  frame += blob;
  return frame;
}

}  // namespace viewer
