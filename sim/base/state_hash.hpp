// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "sim/base/math.hpp"

namespace sim {

/// 64-bit hash over the bits of the state.  It is not cryptographic.
class StateHash {
 public:
  void add(std::uint64_t word) { value_ = mixed(value_, word); }
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
    // Hash four independent chains in parallel: each step of a chain depends on the previous one.
    constexpr std::size_t lanes = 4, min_size_for_lanes = 64;
    if (size >= min_size_for_lanes) {
      std::uint64_t chain[lanes] = {value_, value_ + 1, value_ + 2, value_ + 3};
      for (; size >= sizeof chain; size -= sizeof chain, at += sizeof chain) {
        std::uint64_t words[lanes];
        std::memcpy(words, at, sizeof words);
        for (std::size_t i = 0; i < lanes; ++i) chain[i] = mixed(chain[i], words[i]);
      }
      for (const std::uint64_t each : chain) add(each);
    }
    // Hash the remaining words.
    for (; size >= 8; size -= 8, at += 8) {
      std::uint64_t word;
      std::memcpy(&word, at, 8);
      add(word);
    }
    // Hash the remaining bytes.
    if (size > 0) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, size);
      add(word);
    }
  }
  void add(std::string_view text) { add_bytes(text.data(), text.size()); }
  std::uint64_t value() const { return value_; }

 private:
  /// Chained mixing step, after the 64-bit finalizer of MurmurHash3.
  static std::uint64_t mixed(std::uint64_t value, std::uint64_t word) {
    value ^= word;
    value *= 0xff51afd7ed558ccdULL;
    value ^= value >> 32;
    value *= 0xc4ceb9fe1a85ec53ULL;
    value ^= value >> 29;
    return value;
  }

  std::uint64_t value_ = 0x9e3779b97f4a7c15ULL;
};

}  // namespace sim
