// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "tests/fuzz/fuzz_target.hpp"

namespace fuzz {

/// Takes numbers and texts from the front of an input; zeros and empty ones once it has ended.
class Reader {
 public:
  explicit Reader(Input input) : left_(input) {}

  bool ended() const { return left_.empty(); }
  template <typename Number>
  Number number() {
    Number value{};
    const std::size_t size = std::min(sizeof value, left_.size());
    if (size > 0) std::memcpy(&value, left_.data(), size);
    left_ = left_.subspan(size);
    return value;
  }
  std::uint8_t byte() { return number<std::uint8_t>(); }
  /// A number below `count`.
  std::size_t below(std::size_t count) { return byte() % count; }
  Input bytes(std::size_t size) {
    const Input taken = left_.first(std::min(size, left_.size()));
    left_ = left_.subspan(taken.size());
    return taken;
  }
  /// Its length stands before it, in two bytes.
  std::string text() { return std::string(text_of(bytes(number<std::uint16_t>()))); }
  Input rest() { return bytes(left_.size()); }

 private:
  Input left_;
};

}  // namespace fuzz
