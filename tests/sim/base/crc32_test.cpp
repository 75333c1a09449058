// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/crc32.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

std::uint32_t crc_of(const std::string& text) {
  return sim::crc32({reinterpret_cast<const std::byte*>(text.data()), text.size()});
}

TEST(Crc32, IsTheOneOfZlib) {
  EXPECT_EQ(crc_of("123456789"), 0xCBF43926u);  // the usual check value
  EXPECT_EQ(crc_of(""), 0u);
  EXPECT_EQ(crc_of("The quick brown fox jumps over the lazy dog"), 0x414FA339u);
}

}  // namespace
