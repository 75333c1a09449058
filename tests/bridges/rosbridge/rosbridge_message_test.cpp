// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_message.hpp"

#include <gmock/gmock.h>

#include "bridges/web/web_error.hpp"

namespace {

using namespace bridges::rosbridge;
using Json = nlohmann::json;

std::string error_of(const std::string& text) {
  try {
    parse_message(text);
  } catch (const bridges::WebError& error) {
    return error.what();
  }
  return "";
}

TEST(RosbridgeMessage, ReadsWhatRoslibSends) {
  const ClientMessage message = parse_message(
      R"({"op":"subscribe","id":"subscribe:/a/scan:1","type":"sensor_msgs/msg/LaserScan","topic":"a/scan",
          "compression":"none","throttle_rate":100,"queue_length":2})");
  EXPECT_EQ(message.op, "subscribe");
  EXPECT_EQ(message.id, "subscribe:/a/scan:1");
  EXPECT_EQ(message.topic, "/a/scan");
  EXPECT_EQ(message.type, "sensor_msgs/LaserScan");
  EXPECT_EQ(message.throttle_rate_ms, 100);
  EXPECT_EQ(message.queue_length, 2u);
  const ClientMessage call = parse_message(R"({"op":"call_service","id":7,"service":"/rosapi/topics"})");
  EXPECT_EQ(call.id, "7");
  EXPECT_EQ(call.args, Json::object());
}

TEST(RosbridgeMessage, AWrongMessageSaysWhatIsWrong) {
  const std::pair<const char*, const char*> wrong[] = {
      {"{}", "'op' must be a text of 1 to 64 bytes"},
      {R"({"op":5})", "'op' must be a text of 1 to 64 bytes"},
      {"[]", "message must be a JSON object, got array"},
      {R"({"op":"subscribe"})", "'topic' must be a text of 1 to 256 bytes"},
      {R"({"op":"advertise","topic":"/a"})", "'type' must be a text of 1 to 256 bytes"},
      {R"({"op":"subscribe","topic":"/a","throttle_rate":-1})",
       "'throttle_rate' must be a number from 0 to 3600000, got -1"},
      {R"({"op":"subscribe","topic":"/a","queue_length":"x"})",
       "'queue_length' must be a number from 0 to 1000000, got \"x\""},
      {R"({"op":"set_level","level":"loud"})", "'level' must be error, warning, info or none"},
      {R"({"op":"call_service","service":7})", "'service' must be a text of 1 to 256 bytes"}};
  for (const auto& [text, error] : wrong) EXPECT_EQ(error_of(text), error) << text;
}

TEST(RosbridgeMessage, AStatusAndAResponseHaveTheIdOfTheirRequest) {
  EXPECT_EQ(Json::parse(status_text(Level::error, "no", "a")),
            Json({{"op", "status"}, {"level", "error"}, {"msg", "no"}, {"id", "a"}}));
  EXPECT_EQ(Json::parse(service_response_text("/s", "b", false, "why")),
            Json({{"op", "service_response"}, {"service", "/s"}, {"values", "why"}, {"result", false}, {"id", "b"}}));
}

}  // namespace
