// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/client_message.hpp"

#include <gtest/gtest.h>

#include "bridges/web/web_error.hpp"

namespace {

using bridges::parse_client_message;

std::string error_of(const std::string& text) {
  try {
    parse_client_message(text);
  } catch (const bridges::WebError& error) {
    return error.what();
  }
  return "";
}

TEST(ClientMessage, ReadsWhatTheServerNeeds) {
  EXPECT_EQ(parse_client_message(R"({"op":"hello","token":"abc"})").token, "abc");
  EXPECT_EQ(parse_client_message(R"({"op":"hello"})").token, "");
  EXPECT_EQ(parse_client_message(R"({"op":"hello","token":null})").token, "");
  EXPECT_EQ(parse_client_message(R"({"op":"ack","sequence":4294967295})").sequence, 4294967295u);
  EXPECT_EQ(parse_client_message(R"({"op":"control","id":3})").id, "3");
  EXPECT_EQ(parse_client_message(R"({"op":"control","id":"a"})").id, R"("a")");
  EXPECT_EQ(parse_client_message(R"({"op":"control","id":{"a":1}})").id, "null");
}

TEST(ClientMessage, ErrorsSayWhatIsExpected) {
  EXPECT_EQ(error_of(""), "message is not JSON: error at byte 1");
  EXPECT_EQ(error_of("{\"op\":1e999}"), "message is not JSON: a number is out of range");
  EXPECT_EQ(error_of("{\"op\":\"\xff\"}"), "message is not JSON: error at byte 8");
  EXPECT_EQ(error_of("[]"), "message must be a JSON object, got array");
  EXPECT_EQ(error_of("{}"), "message must have a text 'op'");
  EXPECT_EQ(error_of(R"({"op":5})"), "message must have a text 'op'");
  EXPECT_EQ(error_of(R"({"op":""})"), "'op' must be 1 to 32 characters a-z or '_'");
  EXPECT_EQ(error_of(R"({"op":"A"})"), "'op' must be 1 to 32 characters a-z or '_'");
  EXPECT_EQ(error_of(R"({"op":"hello","token":5})"), "'token' of hello must be a text of at most 256 bytes");
  EXPECT_EQ(error_of(R"({"op":"ack","sequence":4294967296})"),
            "'sequence' of ack must be an integer from 0 to 4294967295");
  EXPECT_EQ(error_of(R"({"op":"ack"})"), "'sequence' of ack must be an integer from 0 to 4294967295");
}

TEST(ClientMessage, DeepNestingIsRefused) {
  const std::string fifteen = std::string(15, '[') + std::string(15, ']'), many = std::string(60'000, '[');
  EXPECT_EQ(error_of(R"({"op":"x","a":)" + fifteen + "}"), "");
  EXPECT_EQ(error_of(R"({"op":"x","a":[)" + fifteen + "]}"), "message is nested more than 16 deep");
  EXPECT_EQ(error_of(many), "message is nested more than 16 deep");
}

TEST(ClientMessage, AnswersAreJsonWhateverTheTextIs) {
  EXPECT_EQ(bridges::error_message("a\"b\n"), R"({"op":"error","text":"a\"b\n"})");
  EXPECT_EQ(bridges::refusal_message("7", "no"), R"({"id":7,"ok":false,"op":"reply","text":"no"})");
  EXPECT_EQ(bridges::with_control(R"({"op":"hello","control":5})", true), R"({"control":true,"op":"hello"})");
}

}  // namespace
