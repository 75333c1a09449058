// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_reassembly.hpp"

#include <algorithm>
#include <utility>

namespace bridges {
namespace {

constexpr std::size_t short_header_bytes = 8;      // magic, sequence number
constexpr std::size_t fragment_header_bytes = 20;  // also message size, offset, fragment number and count
/// Minimum memory accounted for a partial message.
constexpr std::size_t overhead_bytes = 256;
/// Bytes of the payload reserved at the first fragment, so that buffers of images need not grow.
constexpr std::size_t first_reserve_bytes = std::size_t{1} << 20;

/// Reads a big-endian number.
std::uint32_t number_at(std::span<const std::byte> bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes.subspan(offset, size)) value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

/// Returns the channel at the start of `bytes`, without its terminator; empty when there is no valid one.
std::string_view channel_in(std::span<const std::byte> bytes) {
  const auto* begin = reinterpret_cast<const char*>(bytes.data());
  const std::string_view text(begin, std::min(bytes.size(), sim::Bus::max_channel_length + 1));
  const auto length = text.find('\0');
  return length == std::string_view::npos ? std::string_view() : text.substr(0, length);
}

}  // namespace

std::size_t LcmReassembly::Partial::bytes() const {
  return overhead_bytes + payload.capacity() + early_bytes;
}

void LcmReassembly::Partial::add(std::span<const std::byte> part) {
  const std::size_t size = payload.size() + part.size();
  // Double the capacity each time, up to the size of the message.
  if (size > payload.capacity())
    payload.reserve(std::max(size, std::min<std::size_t>(2 * payload.capacity(), message_bytes)));
  payload.insert(payload.end(), part.begin(), part.end());
  ++next;
}

std::nullopt_t LcmReassembly::bad() {
  ++counts_.bad;
  return std::nullopt;
}

std::optional<LcmReassembly::Message> LcmReassembly::add(std::span<const std::byte> datagram,
                                                         const DatagramSender& from,
                                                         const std::function<bool(std::string_view)>& accepts) {
  ++datagrams_;
  if (datagram.size() < short_header_bytes) return bad();
  switch (number_at(datagram, 0, 4)) {
    case short_magic:
      return add_short(datagram);
    case fragment_magic:
      return add_fragment(datagram, std::uint64_t{from.address} << 16 | from.port, accepts);
    default:
      return bad();
  }
}

std::optional<LcmReassembly::Message> LcmReassembly::add_short(std::span<const std::byte> datagram) {
  const auto body = datagram.subspan(short_header_bytes);
  const std::string_view channel = channel_in(body);
  if (channel.empty()) return bad();
  return Message{channel, body.subspan(channel.size() + 1)};
}

std::optional<LcmReassembly::Message> LcmReassembly::add_fragment(
    std::span<const std::byte> datagram, std::uint64_t sender, const std::function<bool(std::string_view)>& accepts) {
  if (datagram.size() < fragment_header_bytes) return bad();
  Fragment fragment{number_at(datagram, 4, 4),
                    number_at(datagram, 8, 4),
                    number_at(datagram, 12, 4),
                    static_cast<std::uint16_t>(number_at(datagram, 16, 2)),
                    static_cast<std::uint16_t>(number_at(datagram, 18, 2)),
                    datagram.subspan(fragment_header_bytes)};
  std::string_view channel;
  if (fragment.number == 0) {
    channel = channel_in(fragment.part);
    if (channel.empty()) return bad();
    fragment.part = fragment.part.subspan(channel.size() + 1);
  }
  // Computed in a wider unsigned type, so that it cannot overflow.
  const std::uint64_t end = std::uint64_t{fragment.offset} + fragment.part.size();
  if (fragment.number >= fragment.count || fragment.message_bytes > limits_.max_message_bytes ||
      end > fragment.message_bytes)
    return bad();

  auto found = partial_.find(sender);
  const bool continues = found != partial_.end() && found->second.sequence == fragment.sequence &&
                         found->second.message_bytes == fragment.message_bytes && found->second.count == fragment.count;
  if (!continues) {
    if (fragment.number != 0) return std::nullopt;
    if (found != partial_.end()) drop(found);
    if (accepts && !accepts(channel)) return std::nullopt;
    found = start_message(sender, channel, fragment);
  }
  Partial& partial = found->second;
  partial.touched_at = datagrams_;
  partial_bytes_ -= partial.bytes();
  const bool fits = append(partial, fragment);
  partial_bytes_ += partial.bytes();
  if (!fits) {
    drop(found);
    return bad();
  }
  if (partial.next != partial.count) {
    make_room(sender);
    return std::nullopt;
  }
  channel_ = std::move(partial.channel);
  partial_bytes_ -= partial.bytes();
  payload_ = std::move(partial.payload);
  partial_.erase(found);
  return Message{channel_, payload_};
}

LcmReassembly::Partials::iterator LcmReassembly::start_message(std::uint64_t sender, std::string_view channel,
                                                               const Fragment& fragment) {
  Partial& partial = partial_[sender];
  partial.channel = channel;
  partial.sequence = fragment.sequence;
  partial.message_bytes = fragment.message_bytes;
  partial.count = fragment.count;
  // Reuse the memory of the last message: new pages cost more than the copy.
  if (payload_.capacity() <= first_reserve_bytes) partial.payload = std::move(payload_);
  partial.payload.clear();
  partial.payload.reserve(std::min<std::size_t>(fragment.message_bytes, first_reserve_bytes));
  partial_bytes_ += partial.bytes();
  return partial_.find(sender);
}

bool LcmReassembly::append(Partial& partial, const Fragment& fragment) {
  if (fragment.number < partial.next) return true;  // repeated
  if (fragment.number > partial.next) return keep_early(partial, fragment);
  if (fragment.offset != partial.payload.size()) return false;
  partial.add(fragment.part);
  // Append early fragments that are due now.
  for (auto first = partial.early.begin(); first != partial.early.end() && first->first <= partial.next;
       first = partial.early.erase(first)) {
    const Early& early = first->second;
    partial.early_bytes -= early.part.size() + overhead_bytes;
    if (early.offset != partial.payload.size()) return false;
    partial.add(early.part);
  }
  return partial.next != partial.count || partial.payload.size() == partial.message_bytes;
}

bool LcmReassembly::keep_early(Partial& partial, const Fragment& fragment) {
  const std::size_t bytes = fragment.part.size() + overhead_bytes;
  if (partial.early.contains(fragment.number)) return true;  // repeated
  if (partial.early_bytes + bytes > limits_.max_early_bytes) return false;
  partial.early.emplace(fragment.number, Early{fragment.offset, {fragment.part.begin(), fragment.part.end()}});
  partial.early_bytes += bytes;
  return true;
}

void LcmReassembly::drop(Partials::iterator partial) {
  partial_bytes_ -= partial->second.bytes();
  partial_.erase(partial);
  ++counts_.dropped;
}

void LcmReassembly::make_room(std::uint64_t keep) {
  while (partial_.size() > 1 &&
         (partial_.size() > limits_.max_partial_messages || partial_bytes_ > limits_.max_partial_bytes)) {
    auto oldest = partial_.end();
    for (auto each = partial_.begin(); each != partial_.end(); ++each)
      if (each->first != keep && (oldest == partial_.end() || each->second.touched_at < oldest->second.touched_at))
        oldest = each;
    drop(oldest);
  }
}

}  // namespace bridges
