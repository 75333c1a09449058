#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "sim/math.hpp"

namespace sim {

/// A 64-bit hash over the bits of the state: equal hashes, equal runs.
class StateHash {
 public:
  void add(std::uint64_t word) {
    // The mixing step of MurmurHash3's 64-bit finalizer, chained.
    value_ ^= word;
    value_ *= 0xff51afd7ed558ccdULL;
    value_ ^= value_ >> 32;
    value_ *= 0xc4ceb9fe1a85ec53ULL;
    value_ ^= value_ >> 29;
  }
  void add(std::int64_t word) { add(static_cast<std::uint64_t>(word)); }
  void add(int word) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(word))); }
  void add(bool flag) { add(static_cast<std::uint64_t>(flag)); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Vector3d& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(std::span<const double> numbers) {
    for (const double number : numbers) add(number);
  }
  void add_bytes(const void* data, std::size_t size) {
    add(static_cast<std::uint64_t>(size));
    const char* at = static_cast<const char*>(data);
    for (; size >= 8; size -= 8, at += 8) {
      std::uint64_t word;
      std::memcpy(&word, at, 8);
      add(word);
    }
    if (size > 0) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, size);
      add(word);
    }
  }
  void add(std::string_view text) { add_bytes(text.data(), text.size()); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0x9e3779b97f4a7c15ULL;
};

}  // namespace sim
