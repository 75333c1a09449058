// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/base64.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace {

using bridges::base64;
using bridges::bytes_of_base64;

TEST(Base64, IsThatOfRfc4648) {
  // The test vectors of section 10, and the two last digits.
  const std::vector<std::pair<std::string, std::string>> pairs{{"", ""},
                                                               {"f", "Zg=="},
                                                               {"fo", "Zm8="},
                                                               {"foo", "Zm9v"},
                                                               {"foob", "Zm9vYg=="},
                                                               {"fooba", "Zm9vYmE="},
                                                               {"foobar", "Zm9vYmFy"},
                                                               {"\xff\xff\xfe", "///+"}};
  for (const auto& [bytes, text] : pairs) {
    EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(bytes_of_base64(text), bytes);
  }
}

TEST(Base64, OtherTextsHaveNoBytes) {
  for (const char* text : {"Z", "Zg", "Zg=", "Zg= ", "Z g=", "Zg==Zg==", "====", "Zm9-", "Zm9\n"})
    EXPECT_EQ(bytes_of_base64(text), std::nullopt) << text;
}

}  // namespace
