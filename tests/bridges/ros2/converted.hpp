// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "bridges/ros2/converter.hpp"
#include "shoal/message_codec.hpp"

namespace test {

/// Reads CDR back, with its alignment.
class CdrReader {
 public:
  explicit CdrReader(std::vector<std::byte> cdr) : cdr_(std::move(cdr)) {}
  template <class T>
  T number() {
    at_ = (at_ - 4 + sizeof(T) - 1) / sizeof(T) * sizeof(T) + 4;
    T value{};
    EXPECT_LE(at_ + sizeof value, cdr_.size());
    if (at_ + sizeof value <= cdr_.size()) std::memcpy(&value, cdr_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text() {
    const auto size = number<std::uint32_t>();
    std::string value(reinterpret_cast<const char*>(cdr_.data() + at_), size - 1);
    at_ += size;
    return value;
  }
  template <class T>
  void skip(int count) {
    for (int i = 0; i < count; ++i) number<T>();
  }
  bool at_end() const { return at_ == cdr_.size(); }

 private:
  std::vector<std::byte> cdr_;
  std::size_t at_ = 4;
};

/// Converts a message; nothing when the converter does not apply.
template <class Message>
std::optional<CdrReader> converted(const Message& message, const std::string& topic,
                                   const std::string& channel = "auv1.x",
                                   bridges::ros2::ConverterContext* context = nullptr) {
  bridges::ros2::ConverterContext fresh;
  for (const bridges::ros2::Converter* each :
       bridges::ros2::ConverterTable::instance().of(std::string("shoal.") + Message::getTypeName())) {
    if (each->topic != topic) continue;
    std::vector<std::byte> cdr;
    if (!each->convert(shoal::encode(message), channel, context != nullptr ? *context : fresh, cdr))
      return std::nullopt;
    return CdrReader(cdr);
  }
  ADD_FAILURE() << "no converter to " << topic;
  return std::nullopt;
}

/// Reads a header with the time 1.5 s.
inline void expect_header(CdrReader& in, const std::string& frame) {
  EXPECT_EQ(in.number<std::int32_t>(), 1);
  EXPECT_EQ(in.number<std::uint32_t>(), 500'000'000u);
  EXPECT_EQ(in.text(), frame);
}

}  // namespace test
