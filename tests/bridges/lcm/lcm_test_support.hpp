// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "shoal/message_schema.hpp"
#include "sim/bus/bus.hpp"
#include "tests/bytes_of.hpp"
#include "tests/own_ports.hpp"
#include "tests/scratch_folder.hpp"

namespace lcm_test {

using namespace std::chrono_literals;

using test_support::own_url;

/// Whether the kernel grants the receive buffer that bursts and images need; stock Debian does not.
inline bool has_large_receive_buffers() {
  long bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> bytes;
  return bytes >= 4194304;
}

using test_support::bytes_of;

inline std::string text_of(const sim::Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Waits for what another thread or process brings about, looking once a millisecond; returns false at the limit, which
/// only ends a test that has failed.
template <class Condition>
bool await(const Condition& condition, std::chrono::milliseconds limit = 60s) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

using test_support::ScratchFolder;

/// Makes a valid payload of any type, by its schema alone: arrays of 0 to 3 elements, strings of 0 to 5
/// characters.
class PayloadBuilder {
 public:
  explicit PayloadBuilder(unsigned seed) : random_(seed) {}

  sim::Bytes build(const shoal::MessageSchema& schema) {
    payload_.clear();
    append(schema.fingerprint, 8);
    add_members(schema, 0);
    return payload_;
  }

 private:
  void append(std::uint64_t value, int size) {
    for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) payload_.push_back(static_cast<std::byte>(value >> shift));
  }

  void add_members(const shoal::MessageSchema& schema, int depth) {
    std::vector<std::int64_t> lengths(static_cast<std::size_t>(schema.length_slots));
    for (const shoal::Member& member : schema.members) {
      std::int64_t count = 1;
      for (const shoal::Dimension& dimension : member.dimensions)
        count *=
            dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)] : dimension.constant;
      for (std::int64_t i = 0; i < count; ++i) add_value(member, lengths, depth);
    }
  }

  void add_value(const shoal::Member& member, std::vector<std::int64_t>& lengths, int depth) {
    if (member.length_slot >= 0) {
      const std::int64_t length = depth > 2 ? 0 : static_cast<std::int64_t>(random_() % 4);
      lengths[static_cast<std::size_t>(member.length_slot)] = length;
      append(static_cast<std::uint64_t>(length), static_cast<int>(shoal::wire_size(member.type)));
      return;
    }
    switch (member.type) {
      case shoal::WireType::compound:
        return add_members(*member.compound, depth + 1);
      case shoal::WireType::string: {
        const auto length = random_() % 6;
        append(length + 1, 4);
        for (std::uint64_t i = 0; i < length; ++i) append('a' + random_() % 26, 1);
        return append(0, 1);
      }
      case shoal::WireType::boolean:
        return append(random_() % 2, 1);
      case shoal::WireType::float32:
        return append(0x3f800000 + random_() % 0x100000, 4);
      case shoal::WireType::float64:
        return append(0x3ff0000000000000 + random_() % 0x100000, 8);
      default:
        return append(random_(), static_cast<int>(shoal::wire_size(member.type)));
    }
  }

  std::mt19937_64 random_;
  sim::Bytes payload_;
};

}  // namespace lcm_test
