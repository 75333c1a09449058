#include "tools/experiment/snapshot_ring.hpp"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace tools {

namespace {

constexpr std::size_t most_in_family = 30;

/// Where the content of each named part of a snapshot is (sim::StateArchive: length and text of the name, length of
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

/// Bytes of `bytes` that agree with the part of the same name and size in `base` become 0.  Done twice it gives back
/// what was there: names and sizes stay.
void take_difference(std::span<std::byte> bytes, std::span<const std::byte> base) {
  std::map<std::string_view, Part> of_base;
  for (const Part& part : parts_of(base)) of_base.emplace(part.name, part);
  for (const Part& part : parts_of(bytes)) {
    const auto known = of_base.find(part.name);
    if (known == of_base.end() || known->second.size != part.size) continue;
    for (std::size_t i = 0; i < part.size; ++i) bytes[part.begin + i] ^= base[known->second.begin + i];
  }
}

sim::Bytes compressed(std::span<const std::byte> bytes) {
  const std::uint64_t size = bytes.size();
  uLongf room = compressBound(static_cast<uLong>(bytes.size()));
  sim::Bytes out(sizeof size + room);
  std::memcpy(out.data(), &size, sizeof size);
  const int outcome = compress2(reinterpret_cast<Bytef*>(out.data() + sizeof size), &room,
                                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 1);
  if (outcome != Z_OK) throw std::runtime_error("a snapshot cannot be compressed");
  out.resize(sizeof size + room);
  out.shrink_to_fit();
  return out;
}

sim::Bytes uncompressed(const sim::Bytes& bytes) {
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof size);
  sim::Bytes out(size);
  uLongf room = static_cast<uLongf>(size);
  const int outcome = uncompress(reinterpret_cast<Bytef*>(out.data()), &room,
                                 reinterpret_cast<const Bytef*>(bytes.data() + sizeof size),
                                 static_cast<uLong>(bytes.size() - sizeof size));
  if (outcome != Z_OK || room != size) throw std::runtime_error("a snapshot in memory is damaged");
  return out;
}

}  // namespace

std::size_t SnapshotRing::Family::bytes() const {
  std::size_t sum = compressed.size();
  for (const Difference& other : others) sum += other.compressed.size();
  return sum;
}

void SnapshotRing::add(std::int64_t step, const sim::Bytes& snapshot, std::size_t bytes_beside) {
  assert(families_.empty() ||
         step > (families_.back().others.empty() ? families_.back().step : families_.back().others.back().step));
  const bool full = !families_.empty() && (families_.back().others.size() + 1 >= most_in_family ||
                                           step - families_.back().step >= std::max<std::int64_t>(steps_ / 2, 1) ||
                                           families_.back().bytes() > most_bytes_ / 4);
  if (families_.empty() || full || whole_.empty()) {
    families_.push_back({step, compressed(snapshot), {}});
    whole_ = snapshot;
    bytes_ += families_.back().compressed.size();
  } else {
    sim::Bytes difference = snapshot;
    take_difference(difference, whole_);
    families_.back().others.push_back({step, compressed(difference)});
    bytes_ += families_.back().others.back().compressed.size();
  }
  ++count_;
  // A family goes when even its last is not needed any more, or when there is no room for it.
  while (families_.size() > 1 && (families_[1].step <= step - steps_ || bytes() + bytes_beside > most_bytes_)) {
    bytes_ -= families_.front().bytes();
    count_ -= 1 + families_.front().others.size();
    families_.pop_front();
  }
}

const SnapshotRing::Family* SnapshotRing::family_of(std::int64_t step) const {
  const auto after = std::find_if(families_.begin(), families_.end(), [&](const Family& f) { return f.step > step; });
  return after == families_.begin() ? nullptr : &*std::prev(after);
}

std::optional<std::int64_t> SnapshotRing::newest_until(std::int64_t step) const {
  const Family* family = family_of(step);
  if (family == nullptr) return std::nullopt;
  std::int64_t newest = family->step;
  for (const Difference& other : family->others)
    if (other.step <= step) newest = other.step;
  return newest;
}

sim::Bytes SnapshotRing::get(std::int64_t step) const {
  const Family* family = family_of(step);
  assert(family != nullptr);
  const sim::Bytes whole = uncompressed(family->compressed);
  if (family->step == step) return whole;
  for (const Difference& other : family->others) {
    if (other.step != step) continue;
    sim::Bytes bytes = uncompressed(other.compressed);
    take_difference(bytes, whole);
    return bytes;
  }
  throw std::logic_error("there is no snapshot of step " + std::to_string(step));
}

void SnapshotRing::forget_after(std::int64_t step) {
  while (!families_.empty() && families_.back().step > step) families_.pop_back();
  if (!families_.empty())
    std::erase_if(families_.back().others, [&](const Difference& other) { return other.step > step; });
  bytes_ = count_ = 0;
  for (const Family& family : families_) {
    bytes_ += family.bytes();
    count_ += 1 + family.others.size();
  }
  whole_ = families_.empty() ? sim::Bytes{} : uncompressed(families_.back().compressed);
}

std::optional<std::int64_t> SnapshotRing::oldest() const {
  return families_.empty() ? std::nullopt : std::optional(families_.front().step);
}

}  // namespace tools
