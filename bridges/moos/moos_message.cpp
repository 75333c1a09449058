// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_message.hpp"

#include <bit>
#include <cstring>

namespace bridges {

namespace {

static_assert(std::endian::native == std::endian::little);  // as numbers are on the wire

template <class Number>
void append(std::vector<std::byte>& out, Number value) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

void append(std::vector<std::byte>& out, const std::string& text) {
  append(out, static_cast<std::int32_t>(text.size()));
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  out.insert(out.end(), bytes, bytes + text.size());
}

/// Writes the length of a part that begins at `start`, into its first four bytes.
void set_length(std::vector<std::byte>& out, std::size_t start) {
  const auto length = static_cast<std::int32_t>(out.size() - start);
  std::memcpy(out.data() + start, &length, sizeof length);
}

// In the order of the wire: length, id, two characters, four texts, three numbers, the text of the value.
void append(std::vector<std::byte>& out, const MoosMessage& message) {
  const std::size_t start = out.size();
  append(out, std::int32_t{0});
  append(out, message.id);
  append(out, static_cast<char>(message.type));
  append(out, message.value_type);
  for (const std::string* text : {&message.source, &message.source_aux, &message.community, &message.key})
    append(out, *text);
  append(out, message.time_s);
  append(out, message.number);
  append(out, -1.0);  // a second number, which MOOS does not use
  append(out, message.text);
  set_length(out, start);
}

constexpr std::size_t packet_header_bytes = 9;
constexpr std::size_t least_message_bytes = 4 + 4 + 2 + 4 * 4 + 3 * 8 + 4;

/// Takes numbers and texts from the front of bytes.
class WireReader {
 public:
  explicit WireReader(std::span<const std::byte> bytes) : left_(bytes) {}

  std::span<const std::byte> bytes(std::size_t size) {
    if (size > left_.size()) throw MoosError("a message of MOOS ends within a value");
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto size = number<std::int32_t>();
    if (size < 0) throw MoosError("a text of MOOS has a length of " + std::to_string(size));
    const auto taken = bytes(static_cast<std::size_t>(size));
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  std::span<const std::byte> left_;
};

MoosMessage read_message(WireReader& packet) {
  const auto length = packet.number<std::int32_t>();
  if (length < static_cast<std::int32_t>(least_message_bytes))
    throw MoosError("a message of MOOS has a length of " + std::to_string(length));
  WireReader in(packet.bytes(static_cast<std::size_t>(length) - sizeof length));
  MoosMessage message;
  message.id = in.number<std::int32_t>();
  message.type = static_cast<MoosType>(in.number<char>());
  message.value_type = in.number<char>();
  for (std::string* text : {&message.source, &message.source_aux, &message.community, &message.key}) *text = in.text();
  message.time_s = in.number<double>();
  message.number = in.number<double>();
  in.number<double>();
  message.text = in.text();
  return message;
}

void read_packet(std::span<const std::byte> bytes, std::vector<MoosMessage>& messages) {
  WireReader packet(bytes.subspan(sizeof(std::int32_t)));
  const auto count = packet.number<std::int32_t>();
  if (packet.number<std::uint8_t>() != 0) throw MoosError("a packet of MOOS is compressed, which is not supported");
  if (count < 0 || static_cast<std::size_t>(count) > bytes.size() / least_message_bytes)
    throw MoosError("a packet of MOOS has " + std::to_string(bytes.size()) + " bytes and " + std::to_string(count) +
                    " messages");
  for (std::int32_t i = 0; i < count; ++i) messages.push_back(read_message(packet));
}

}  // namespace

std::vector<std::byte> encode_moos_packet(std::span<const MoosMessage> messages) {
  std::vector<std::byte> out;
  append(out, std::int32_t{0});
  append(out, static_cast<std::int32_t>(messages.size()));
  append(out, std::uint8_t{0});
  for (const MoosMessage& message : messages) append(out, message);
  set_length(out, 0);
  return out;
}

std::vector<MoosMessage> MoosPacketReader::add(std::span<const std::byte> bytes) {
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  std::vector<MoosMessage> messages;
  std::size_t at = 0;
  while (waiting_.size() - at >= sizeof(std::int32_t)) {
    const std::span<const std::byte> left(waiting_.data() + at, waiting_.size() - at);
    const auto length = WireReader(left).number<std::int32_t>();
    if (length < static_cast<std::int32_t>(packet_header_bytes) || length > max_packet_bytes)
      throw MoosError("a packet of MOOS has a length of " + std::to_string(length));
    if (left.size() < static_cast<std::size_t>(length)) break;
    read_packet(left.first(static_cast<std::size_t>(length)), messages);
    at += static_cast<std::size_t>(length);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at));
  return messages;
}

}  // namespace bridges
