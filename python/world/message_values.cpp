// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/message_values.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "python/world/error.hpp"
#include "shoal/wire_value.hpp"

namespace python {
namespace {

using shoal::Member;
using shoal::MessageSchema;
using shoal::WireType;
using Lengths = std::array<std::int64_t, 64>;

std::size_t elements(const Member& member, const Lengths& lengths) {
  std::size_t count = 1;
  for (const shoal::Dimension& dimension : member.dimensions)
    count *= static_cast<std::size_t>(dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)]
                                                              : dimension.constant);
  return count;
}

/// Returns the first byte behind a member, whose elements must be numbers.
const std::byte* behind(const MessageSchema& schema, const std::byte* at);

const std::byte* behind(const Member& member, const std::byte* at, Lengths& lengths) {
  if (member.length_slot >= 0)
    lengths[static_cast<std::size_t>(member.length_slot)] = shoal::read_integer(member.type, at);
  const std::size_t count = elements(member, lengths);
  if (member.type == WireType::compound) {
    for (std::size_t i = 0; i < count; ++i) at = behind(*member.compound, at);
    return at;
  }
  if (member.type == WireType::string) {
    for (std::size_t i = 0; i < count; ++i) at += sizeof(std::uint32_t) + shoal::big_endian<std::uint32_t>(at);
    return at;
  }
  return at + count * shoal::wire_size(member.type);
}

const std::byte* behind(const MessageSchema& schema, const std::byte* at) {
  Lengths lengths;  // each is set before it is used
  for (const Member& member : schema.members) at = behind(member, at, lengths);
  return at;
}

bool is_real(WireType type) {
  return type == WireType::float32 || type == WireType::float64;
}

std::size_t member_of(const MessageSchema& schema, const std::string& name, bool single) {
  for (std::size_t i = 0; i < schema.members.size(); ++i) {
    const Member& member = schema.members[i];
    if (member.name != name) continue;
    if (member.type == WireType::compound || member.type == WireType::string ||
        (single && !member.dimensions.empty()) || member.length_slot >= 0)
      throw Error("member '" + name + "' of " + schema.name + " has no " + (single ? "single number" : "numbers"));
    return i;
  }
  throw Error(schema.name + " has no member '" + name + "'");
}

/// Appends the value zero of a type.
void append_zero(const MessageSchema& schema, sim::Bytes& out) {
  for (const Member& member : schema.members) {
    std::size_t count = 1;
    for (const shoal::Dimension& dimension : member.dimensions)
      count *= dimension.is_variable() ? 0 : static_cast<std::size_t>(dimension.constant);
    for (std::size_t i = 0; i < count; ++i) {
      if (member.type == WireType::compound)
        append_zero(*member.compound, out);
      else if (member.type == WireType::string)
        out.insert(out.end(), {std::byte{0}, std::byte{0}, std::byte{0}, std::byte{1}, std::byte{0}});
      else
        out.resize(out.size() + shoal::wire_size(member.type));
    }
  }
}

template <class T>
void put_big_endian(std::byte* at, T value) {
  for (std::size_t i = sizeof(T); i-- > 0;) *at++ = static_cast<std::byte>(value >> (8 * i) & 0xff);
}

}  // namespace

MemberReader::MemberReader(const MessageSchema& schema, const std::string& member)
    : schema_(schema), member_(member_of(schema, member, false)) {}

MemberReader::Found MemberReader::find(std::span<const std::byte> payload) const {
  const std::byte* at = payload.data() + sizeof(std::uint64_t);
  Lengths lengths;  // each is set before it is used
  for (std::size_t i = 0; i < member_; ++i) at = behind(schema_.members[i], at, lengths);
  return {at, elements(schema_.members[member_], lengths)};
}

std::size_t MemberReader::count(std::span<const std::byte> payload) const {
  return find(payload).count;
}

void MemberReader::read(std::span<const std::byte> payload, std::span<double> out) const {
  const Found found = find(payload);
  const WireType type = schema_.members[member_].type;
  const std::size_t size = shoal::wire_size(type);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::byte* const at = found.at + i * size;
    out[i] = i >= found.count ? std::numeric_limits<double>::quiet_NaN()
             : is_real(type)  ? shoal::read_real(type, at)
                              : static_cast<double>(shoal::read_integer(type, at));
  }
}

MessageForm::MessageForm(const MessageSchema& schema, const std::vector<std::string>& members) {
  // The payload is made once and only its numbers are filled in at each step: encoding an object per step would
  // dominate the time of a small world.
  payload_.resize(sizeof(std::uint64_t));
  put_big_endian(payload_.data(), schema.fingerprint);
  append_zero(schema, payload_);
  const auto slot_of = [&](std::size_t index) {
    const std::byte* at = payload_.data() + sizeof(std::uint64_t);
    Lengths lengths;
    for (std::size_t i = 0; i < index; ++i) at = behind(schema.members[i], at, lengths);
    return Slot{static_cast<std::size_t>(at - payload_.data()), schema.members[index].type};
  };
  for (const std::string& member : members) slots_.push_back(slot_of(member_of(schema, member, true)));
  for (std::size_t i = 0; i < schema.members.size(); ++i)
    if (schema.members[i].name == "utime" && schema.members[i].type == WireType::int64) utime_at_ = slot_of(i).offset;
}

std::span<const std::byte> MessageForm::fill(std::span<const double> values, std::int64_t utime) {
  for (std::size_t i = 0; i < slots_.size(); ++i) put(slots_[i], values[i]);
  if (utime_at_ > 0) put_big_endian(payload_.data() + utime_at_, static_cast<std::uint64_t>(utime));
  return payload_;
}

void MessageForm::put(const Slot& slot, double value) {
  std::byte* const at = payload_.data() + slot.offset;
  if (slot.type == WireType::float64) return put_big_endian(at, std::bit_cast<std::uint64_t>(value));
  if (slot.type == WireType::float32)
    return put_big_endian(at, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  // NaN has no integer: zero
  const auto whole = static_cast<std::int64_t>(std::isfinite(value) ? std::clamp(std::round(value), -9e15, 9e15) : 0);
  switch (shoal::wire_size(slot.type)) {
    case 1:
      return put_big_endian(at, static_cast<std::uint8_t>(whole));
    case 2:
      return put_big_endian(at, static_cast<std::uint16_t>(whole));
    case 4:
      return put_big_endian(at, static_cast<std::uint32_t>(whole));
    default:
      return put_big_endian(at, static_cast<std::uint64_t>(whole));
  }
}

}  // namespace python
