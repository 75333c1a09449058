// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_ring.hpp"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace experiment {

namespace {

constexpr std::size_t max_in_family = 30;

/// Position of the content of each named part of a snapshot (sim::StateArchive: length and text of the name, length of
/// the content, content).
struct Part {
  std::string_view name;
  std::size_t begin, size;
};

std::vector<Part> parts_of(std::span<const std::byte> bytes) {
  std::vector<Part> parts;
  std::size_t at = 0;
  const auto length = [&](std::uint64_t& value) {
    if (bytes.size() - at < sizeof value) return false;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value <= bytes.size() - at;
  };
  while (at < bytes.size()) {
    std::uint64_t name_size = 0, size = 0;
    if (!length(name_size)) return {};
    const std::string_view name(reinterpret_cast<const char*>(bytes.data() + at), name_size);
    at += name_size;
    if (!length(size)) return {};
    parts.push_back({name, at, size});
    at += size;
  }
  return parts;
}

void exclusive_or(std::span<std::byte> bytes, std::span<const std::byte> others) {
  std::size_t i = 0;
  for (std::uint64_t a = 0, b = 0; i + sizeof a <= bytes.size(); i += sizeof a) {
    std::memcpy(&a, bytes.data() + i, sizeof a);
    std::memcpy(&b, others.data() + i, sizeof b);
    a ^= b;
    std::memcpy(bytes.data() + i, &a, sizeof a);
  }
  for (; i < bytes.size(); ++i) bytes[i] ^= others[i];
}

/// Takes the difference: bytes of `bytes` that equal the part of the same name and size in `base` become 0.  Applying
/// it twice restores the original, because names and sizes are kept.
void take_difference(std::span<std::byte> bytes, std::span<const std::byte> base) {
  std::map<std::string_view, Part> of_base;
  for (const Part& part : parts_of(base)) of_base.emplace(part.name, part);
  for (const Part& part : parts_of(bytes)) {
    const auto known = of_base.find(part.name);
    if (known == of_base.end() || known->second.size != part.size) continue;
    exclusive_or(bytes.subspan(part.begin, part.size), base.subspan(known->second.begin, part.size));
  }
}

/// Run-length encoding of zeros, in words of 8 bytes: alternately the number of zero words, the number of others, and
/// these.
constexpr std::size_t word_bytes = sizeof(std::uint64_t);

void append(sim::Bytes& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_number(sim::Bytes& out, std::uint64_t number) {
  append(out, std::as_bytes(std::span(&number, 1)));
}

std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint64_t number = 0;
  if (bytes.size() < at + sizeof number) throw std::runtime_error("a snapshot in memory is damaged");
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

sim::Bytes without_zeros(std::span<const std::byte> bytes) {
  const std::size_t words = bytes.size() / word_bytes;
  const auto is_zero = [&](std::size_t i) { return number_at(bytes, i * word_bytes) == 0; };
  sim::Bytes out;
  out.reserve(bytes.size() / 2);
  append_number(out, bytes.size());
  for (std::size_t i = 0; i < words;) {
    std::size_t begin = i;
    while (begin < words && is_zero(begin)) ++begin;
    std::size_t end = begin;
    // One zero word among others costs less than another pair of numbers.
    while (end < words && !(is_zero(end) && (end + 1 == words || is_zero(end + 1)))) ++end;
    append_number(out, (begin - i) << 32 | (end - begin));
    append(out, bytes.subspan(begin * word_bytes, (end - begin) * word_bytes));
    i = end;
  }
  append(out, bytes.subspan(words * word_bytes));
  return out;
}

sim::Bytes with_zeros(std::span<const std::byte> bytes) {
  sim::Bytes out(number_at(bytes, 0));
  const std::size_t words = out.size() / word_bytes;
  // The size, then pairs of numbers: so many words of zeros, so many others, which follow.
  std::size_t from = sizeof(std::uint64_t), to = 0;
  while (to < words) {
    const std::uint64_t pair = number_at(bytes, from);
    const std::size_t zeros = pair >> 32, others = pair & 0xffffffff;
    from += sizeof pair;
    to += zeros;
    if (to + others > words || others * word_bytes > bytes.size() - from || zeros + others == 0)
      throw std::runtime_error("a snapshot in memory is damaged");
    std::memcpy(out.data() + to * word_bytes, bytes.data() + from, others * word_bytes);
    to += others;
    from += others * word_bytes;
  }
  if (bytes.size() - from != out.size() % word_bytes) throw std::runtime_error("a snapshot in memory is damaged");
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end(),
            out.begin() + static_cast<std::ptrdiff_t>(words * word_bytes));
  return out;
}

sim::Bytes deflated(std::span<const std::byte> bytes) {
  uLongf room = compressBound(static_cast<uLong>(bytes.size()));
  sim::Bytes out(sizeof(std::uint64_t) + room);
  const std::uint64_t size = bytes.size();
  std::memcpy(out.data(), &size, sizeof size);
  // Level 1: the ring is filled while the run waits, and differences of snapshots are mostly zeros.
  const int outcome = compress2(reinterpret_cast<Bytef*>(out.data() + sizeof size), &room,
                                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 1);
  if (outcome != Z_OK) throw std::runtime_error("a snapshot cannot be compressed");
  out.resize(sizeof size + room);
  out.shrink_to_fit();
  return out;
}

sim::Bytes inflated(const sim::Bytes& bytes) {
  const std::uint64_t size = number_at(bytes, 0);
  sim::Bytes out(size);
  uLongf room = static_cast<uLongf>(size);
  const int outcome = uncompress(reinterpret_cast<Bytef*>(out.data()), &room,
                                 reinterpret_cast<const Bytef*>(bytes.data() + sizeof size),
                                 static_cast<uLong>(bytes.size() - sizeof size));
  if (outcome != Z_OK || room != size) throw std::runtime_error("a snapshot in memory is damaged");
  return out;
}

}  // namespace

sim::Bytes SnapshotRing::Packed::unpacked() const {
  return with_zeros(deflated ? inflated(bytes) : bytes);
}

/// Deflate is slower than all other work of a snapshot: it is used only when space is short.
SnapshotRing::Packed SnapshotRing::pack(std::int64_t step, std::span<const std::byte> bytes) const {
  Packed packed{step, without_zeros(bytes), false};
  const std::int64_t apart = count_ == 0 ? 1 : std::max<std::int64_t>(1, step - newest());
  const double all =
      static_cast<double>(packed.bytes.size()) * static_cast<double>(steps_) / static_cast<double>(apart);
  packed.deflated = all > static_cast<double>(max_bytes_) / 2;
  if (packed.deflated)
    packed.bytes = deflated(packed.bytes);
  else
    packed.bytes.shrink_to_fit();
  return packed;
}

std::int64_t SnapshotRing::newest() const {
  const Family& last = families_.back();
  return last.others.empty() ? last.whole.step : last.others.back().step;
}

std::size_t SnapshotRing::Family::bytes() const {
  std::size_t sum = whole.bytes.size();
  for (const Packed& other : others) sum += other.bytes.size();
  return sum;
}

void SnapshotRing::add(std::int64_t step, const sim::Bytes& snapshot, std::size_t bytes_beside) {
  assert(families_.empty() || step > newest());
  // Store a full snapshot, or the difference from the last full one.
  const bool full =
      !families_.empty() && (families_.back().others.size() + 1 >= max_in_family ||
                             step - families_.back().whole.step >= std::max<std::int64_t>(steps_ / 2, 1) ||
                             families_.back().bytes() > max_bytes_ / 4);
  if (families_.empty() || full || whole_.empty()) {
    families_.push_back({pack(step, snapshot), {}});
    whole_ = snapshot;
    bytes_ += families_.back().whole.bytes.size();
  } else {
    difference_ = snapshot;
    take_difference(difference_, whole_);
    families_.back().others.push_back(pack(step, difference_));
    bytes_ += families_.back().others.back().bytes.size();
  }
  ++count_;
  // Remove a family when even its last snapshot is too old, or when space is short.
  while (families_.size() > 1 && (families_[1].whole.step <= step - steps_ || bytes() + bytes_beside > max_bytes_)) {
    bytes_ -= families_.front().bytes();
    count_ -= 1 + families_.front().others.size();
    families_.pop_front();
  }
}

const SnapshotRing::Family* SnapshotRing::family_of(std::int64_t step) const {
  const auto after =
      std::find_if(families_.begin(), families_.end(), [&](const Family& f) { return f.whole.step > step; });
  return after == families_.begin() ? nullptr : &*std::prev(after);
}

std::optional<std::int64_t> SnapshotRing::newest_until(std::int64_t step) const {
  const Family* family = family_of(step);
  if (family == nullptr) return std::nullopt;
  std::int64_t newest = family->whole.step;
  for (const Packed& other : family->others)
    if (other.step <= step) newest = other.step;
  return newest;
}

sim::Bytes SnapshotRing::get(std::int64_t step) const {
  const Family* family = family_of(step);
  assert(family != nullptr);
  const sim::Bytes whole = family->whole.unpacked();
  if (family->whole.step == step) return whole;
  for (const Packed& other : family->others) {
    if (other.step != step) continue;
    sim::Bytes bytes = other.unpacked();
    // All but the first snapshot of a family are stored as differences from it.
    take_difference(bytes, whole);
    return bytes;
  }
  throw std::logic_error("there is no snapshot of step " + std::to_string(step));
}

void SnapshotRing::discard_after(std::int64_t step) {
  while (!families_.empty() && families_.back().whole.step > step) families_.pop_back();
  if (!families_.empty())
    std::erase_if(families_.back().others, [&](const Packed& other) { return other.step > step; });
  bytes_ = count_ = 0;
  for (const Family& family : families_) {
    bytes_ += family.bytes();
    count_ += 1 + family.others.size();
  }
  if (families_.empty()) difference_ = {};
  whole_ = families_.empty() ? sim::Bytes{} : families_.back().whole.unpacked();
}

std::optional<std::int64_t> SnapshotRing::oldest() const {
  return families_.empty() ? std::nullopt : std::optional(families_.front().whole.step);
}

}  // namespace experiment
