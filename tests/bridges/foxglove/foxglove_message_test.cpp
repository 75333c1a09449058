// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_message.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "bridges/foxglove/foxglove_services.hpp"
#include "bridges/web/web_error.hpp"
#include "tests/bridges/foxglove/foxglove_bytes.hpp"

namespace {

using namespace foxglove_bytes;
using namespace bridges::foxglove;

using testing::HasSubstr;
using testing::SizeIs;

TEST(FoxgloveMessage, ReadsSubscriptions) {
  const ClientText message =
      parse_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":7},{"id":2,"channelId":8}]})");
  EXPECT_EQ(message.op, "subscribe");
  ASSERT_THAT(message.subscriptions, SizeIs(2));
  EXPECT_EQ(message.subscriptions[1].id, 2u);
  EXPECT_EQ(message.subscriptions[1].channel, 8u);
  EXPECT_EQ(parse_text(R"({"op":"unsubscribe","subscriptionIds":[3]})").subscription_ids.front(), 3u);
}

TEST(FoxgloveMessage, ReadsParameters) {
  const ClientText message = parse_text(
      R"({"op":"setParameters","id":"a","parameters":[{"name":"paused","value":true},{"name":"speed","value":2}]})");
  EXPECT_EQ(message.id, "a");
  ASSERT_THAT(message.parameters, SizeIs(2));
  EXPECT_EQ(std::get<bool>(message.parameters[0].value), true);
  EXPECT_EQ(std::get<double>(message.parameters[1].value), 2);
  EXPECT_EQ(parse_text(R"({"op":"getParameters","parameterNames":["speed"]})").names.front(), "speed");
}

TEST(FoxgloveMessage, RefusesTextsThatAreNotMessages) {
  EXPECT_THAT(error_of([] { parse_text("[]"); }), HasSubstr("must be a JSON object"));
  EXPECT_THAT(error_of([] { parse_text("{"); }), HasSubstr("not JSON"));
  EXPECT_THAT(error_of([] { parse_text("{}"); }), HasSubstr("'op'"));
  EXPECT_THAT(error_of([] { parse_text(R"({"op":"subscribe"})"); }), HasSubstr("a list 'subscriptions'"));
  EXPECT_THAT(error_of([] { parse_text(R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"); }),
              HasSubstr("0 to 4294967295"));
  EXPECT_THAT(error_of([] { parse_text(R"({"op":"subscribe","subscriptions":[{"id":1}]})"); }),
              HasSubstr("must have 'channelId'"));
  EXPECT_THAT(error_of([] { parse_text(std::string(20, '[')); }), HasSubstr("more than 16 deep"));
  EXPECT_THAT(error_of([] { parse_text(R"({"op":")" + std::string(65, 'a') + "\"}"); }), HasSubstr("64 bytes"));
}

TEST(FoxgloveMessage, ReadsPlaybackRequests) {
  const std::string head = std::string("\3\1", 2) + bytes_of_number(2.0F);
  const auto seek = std::get<PlaybackRequest>(
      parse_binary(head + "\1" + bytes_of_number(std::uint64_t{5'000'000'123}) + text_bytes("id")));
  EXPECT_FALSE(seek.plays);
  EXPECT_EQ(seek.speed, 2);
  EXPECT_EQ(seek.seek_us, 5'000'000);
  EXPECT_EQ(seek.id, "id");
  const auto none = std::get<PlaybackRequest>(
      parse_binary(head + std::string(1, '\0') + bytes_of_number(std::uint64_t{5}) + text_bytes("")));
  EXPECT_EQ(none.seek_us, std::nullopt);
}

TEST(FoxgloveMessage, RefusesBinaryMessagesOfAWrongForm) {
  const auto playback = [](char command, float speed, const std::string& end) {
    return std::string("\3") + command + bytes_of_number(speed) + std::string(9, '\0') + end;
  };
  EXPECT_THAT(error_of([] { parse_binary(""); }), HasSubstr("too short"));
  EXPECT_THAT(error_of([] { parse_binary("\7"); }), HasSubstr("unknown opcode 7"));
  EXPECT_THAT(error_of([] { parse_binary(std::string("\1\0\0\0\0", 5)); }), HasSubstr("not accepted"));
  EXPECT_THAT(error_of([&] { parse_binary(playback(2, 1, text_bytes(""))); }), HasSubstr("0 (play) or 1 (pause)"));
  for (const float speed : {0.0F, -1.0F, 2000.0F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THAT(error_of([&] { parse_binary(playback(0, speed, text_bytes(""))); }), HasSubstr("0.01 to 1000"));
  EXPECT_THAT(error_of([&] { parse_binary(playback(0, 1, text_bytes("") + "x")); }), HasSubstr("too long"));
  EXPECT_THAT(error_of([&] { parse_binary(playback(0, 1, bytes_of_number(std::uint32_t{4'000'000'000}))); }),
              HasSubstr("at most 256 bytes"));
}

TEST(FoxgloveMessage, ReadsServiceCalls) {
  const auto call = std::get<ServiceCall>(parse_binary("\2" + bytes_of_number(std::uint32_t{5}) +
                                                       bytes_of_number(std::uint32_t{9}) + text_bytes("json") + "{}"));
  EXPECT_EQ(call.service, 5u);
  EXPECT_EQ(call.call, 9u);
  EXPECT_EQ(call.encoding, "json");
  EXPECT_EQ(call.payload, "{}");
}

}  // namespace
