// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/client_json.hpp"

#include <gtest/gtest.h>

#include <string>

#include "bridges/web/web_error.hpp"

namespace {

std::string error_of(const std::string& text) {
  try {
    bridges::parse_client_json(text);
  } catch (const bridges::WebError& error) {
    return error.what();
  }
  return "none";
}

TEST(ClientJson, IsAnObject) {
  EXPECT_EQ(bridges::parse_client_json(R"({"op": "pause"})").at("op"), "pause");
  EXPECT_EQ(error_of("[1]"), "message must be a JSON object, got array");
  EXPECT_EQ(error_of("null"), "message must be a JSON object, got null");
}

TEST(ClientJson, IsNestedSixteenDeepAtMost) {
  const auto nested = [](int depth) {
    return R"({"a":)" + std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']') + "}";
  };
  EXPECT_EQ(error_of(nested(15)), "none");
  EXPECT_EQ(error_of(nested(16)), "message is nested more than 16 deep");
  EXPECT_EQ(error_of(nested(100'000)), "message is nested more than 16 deep");
}

TEST(ClientJson, SaysAtWhichByteItIsNone) {
  EXPECT_EQ(error_of("{\"a\" 1}"), "message is not JSON: error at byte 6");
  EXPECT_EQ(error_of("{\"a\": 1e999}"), "message is not JSON: a number is out of range");
}

}  // namespace
