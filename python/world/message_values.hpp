// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "shoal/message_schema.hpp"
#include "sim/bus/bus.hpp"

namespace python {

/// Reads the numbers of one member of a message, such as the ranges of a lidar, from its payload.
class MemberReader {
 public:
  /// Throws Error when the type has no such member of numbers.
  MemberReader(const shoal::MessageSchema& schema, const std::string& member);

  /// Returns how many numbers the member of this payload has.
  std::size_t count(std::span<const std::byte> payload) const;
  /// Writes them to `out`; an array of another length is cut off or filled up with NaN.  The payload must be a
  /// valid one of the type.
  void read(std::span<const std::byte> payload, std::span<double> out) const;

 private:
  struct Found {
    const std::byte* at;
    std::size_t count;
  };
  Found find(std::span<const std::byte> payload) const;

  const shoal::MessageSchema& schema_;
  std::size_t member_ = 0;
};

/// Message with some of its numbers to be set, such as the speeds of a command.
class MessageForm {
 public:
  /// All arrays of variable length are empty.  Throws Error when the type has no such members of single numbers.
  MessageForm(const shoal::MessageSchema& schema, const std::vector<std::string>& members);

  std::size_t count() const { return slots_.size(); }
  /// Returns the payload with these values, and with the time when the type has a member `utime`.
  std::span<const std::byte> fill(std::span<const double> values, std::int64_t utime);

 private:
  struct Slot {
    std::size_t offset;
    shoal::WireType type;
  };
  void put(const Slot& slot, double value);

  sim::Bytes payload_;
  std::vector<Slot> slots_;
  std::size_t utime_at_ = 0;  // 0: there is none
};

}  // namespace python
