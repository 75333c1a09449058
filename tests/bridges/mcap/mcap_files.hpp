// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"
#include "bridges/mcap/mcap_writer.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace mcap_files {

using namespace bridges::mcap;

inline bridges::FileDescriptor file_at(const std::string& path) {
  return bridges::FileDescriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
}

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Two channels, and `count` messages of 100 bytes, one each millisecond.
inline void write_file(const std::string& path, int count) {
  McapWriter writer(file_at(path));
  const std::uint16_t schema = writer.add_schema({"p/msg/A", "ros2msg", "int32 x\n"});
  const std::uint16_t a = writer.add_channel({schema, "/a", "cdr", {{"key", "value"}}});
  const std::uint16_t b = writer.add_channel({0, "/b", "lcm", {}});
  EXPECT_TRUE(writer.write(Metadata{"shoal", {{"seed", "7"}}}));
  EXPECT_TRUE(writer.write(Attachment{1, 2, "world.yaml", "application/yaml", "name: x\n"}));
  std::mt19937 random(1);
  for (int i = 0; i < count; ++i) {
    std::string text = std::to_string(i);
    while (text.size() < 100) text += static_cast<char>('a' + random() % 26);
    EXPECT_TRUE(writer.write(i % 3 == 0 ? b : a, 1'000'000 * static_cast<std::uint64_t>(i), lcm_test::bytes_of(text)));
  }
  EXPECT_TRUE(writer.finish());
}

template <class T>
T number_at(const std::string& content, std::size_t at) {
  T value{};
  std::memcpy(&value, content.data() + at, sizeof value);
  return value;
}

}  // namespace mcap_files
