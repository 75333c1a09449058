// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/ros_json.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "bridges/ros2/cdr.hpp"
#include "bridges/web/web_error.hpp"

namespace {

using bridges::ros2::CdrWriter;
using bridges::rosbridge::append_json;
using bridges::rosbridge::cdr_of_json;
using bridges::rosbridge::RosType;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string_view view_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string json_of(const RosType& type, const std::vector<std::byte>& cdr) {
  std::string text;
  EXPECT_TRUE(append_json(type, view_of(cdr), text)) << text;
  return text;
}

std::string error_of(const RosType& type, const std::string& message) {
  try {
    cdr_of_json(type, Json::parse(message));
  } catch (const bridges::WebError& error) {
    return error.what();
  }
  return "";
}

const RosType& mixed() {
  static const RosType type("a_msgs/msg/Mixed",
                            "int8 small  # a comment\nint32 MOST=7\nfloat64 real\nuint8[] data\nuint8[2] pair\n"
                            "string[] names\na_msgs/Point[] points\nbool flag\nuint64 large\n"
                            "================\nMSG: a_msgs/Point\nfloat32 x\n");
  return type;
}

TEST(RosType, KnowsMembersArraysAndTheTypesThatItUses) {
  const auto& all = mixed().definitions();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "a_msgs/Mixed");
  ASSERT_EQ(all[0].members.size(), 8u);  // the constant is none
  EXPECT_EQ(all[0].members[3].count, 2u);
  EXPECT_EQ(all[0].members[5].compound, 1u);
  EXPECT_THROW(RosType("a/B", "c/D d\n"), std::invalid_argument);
}

TEST(RosJson, WritesAMessageAsClientsOfRosbridgeExpectIt) {
  std::vector<std::byte> cdr;
  CdrWriter out(cdr);
  out.put(std::int8_t{-3});
  out.put(nan);
  out.put_sequence<std::uint8_t>(std::vector<std::uint8_t>{'f', 'o', 'o'});  // Zm9v: RFC 4648, section 10
  out.put_array<std::uint8_t>(std::vector<std::uint8_t>{'f', 'o'});
  out.put_count(2);
  out.put(std::string_view("a\"b"));
  out.put(std::string_view(""));
  out.put_count(2);
  out.put(0.1f);
  out.put(-std::numeric_limits<float>::infinity());
  out.put(std::uint8_t{1});
  out.put(std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(json_of(mixed(), cdr), R"({"small":-3,"real":null,"data":"Zm9v","pair":"Zm8=","names":["a\"b",""],)"
                                   R"("points":[{"x":0.1},{"x":null}],"flag":true,"large":18446744073709551615})");
}

TEST(RosJson, AMessageOfAClientComesBackAsItWas) {
  const std::string text =
      R"({"small":-128,"real":0.1,"data":"Zm9vYg==","pair":"AAE=","names":["x"],"points":[{"x":1.5}],"flag":false,)"
      R"("large":9007199254740993})";
  EXPECT_EQ(json_of(mixed(), cdr_of_json(mixed(), Json::parse(text))), text);
}

TEST(RosJson, BytesMayBeAListAndMissingMembersAreZero) {
  EXPECT_EQ(json_of(mixed(), cdr_of_json(mixed(), Json::parse(R"({"data":[102,111,111]})"))),
            R"({"small":0,"real":0,"data":"Zm9v","pair":"AAA=","names":[],"points":[],"flag":false,"large":0})");
  // Where a missing number means "as before", it is not a number
  const RosType helm("a_msgs/msg/Helm", "float64 speed\nfloat64 depth\nint64 utime\n");
  EXPECT_EQ(json_of(helm, cdr_of_json(helm, Json::parse(R"({"speed":2})"), nan)),
            R"({"speed":2,"depth":null,"utime":0})");
}

TEST(RosJson, AWholeNumberMayBeWrittenWithAFraction) {
  EXPECT_THAT(json_of(mixed(), cdr_of_json(mixed(), Json::parse(R"({"small":5.0})"))), HasSubstr(R"("small":5,)"));
}

TEST(RosJson, AWrongMemberIsNamedWithItsRule) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"small":128})", "'msg.small': must be an integer from -128 to 127, got 128"},
      {R"({"small":1.5})", "'msg.small': must be an integer from -128 to 127, got 1.5"},
      {R"({"large":-1})", "'msg.large': must be an integer from 0 to 18446744073709551615, got -1"},
      {R"({"real":"x"})", "'msg.real': must be a number or null, got \"x\""},
      {R"({"flag":1})", "'msg.flag': must be true or false, got 1"},
      {R"({"names":[1]})", "'msg.names': must be a text, got 1"},
      {R"({"names":"x"})", "'msg.names': must be a list, got \"x\""},
      {R"({"pair":[1]})", "'msg.pair': must have 2 values, got 1"},
      {R"({"pair":"AA=="})", "'msg.pair': must have 2 bytes, got 1"},
      {R"({"data":"A"})", "'msg.data': must be a list of bytes, or text in base64"},
      {R"({"points":[{"y":1}]})", "'msg.points': a_msgs/Point has no member \"y\""},
      {R"({"points":[3]})", "'msg.points': must be an object, got 3"},
      {R"({"speed":1})", "'msg': a_msgs/Mixed has no member \"speed\""},
      {R"([])", "'msg': must be an object, got []"}};
  for (const auto& [message, error] : wrong) EXPECT_EQ(error_of(mixed(), message), error);
}

TEST(RosJson, AMessageDoesNotGrowWithoutLimit) {
  // Each {} of 3 bytes is 288 bytes of a pose with its covariance.
  const RosType list("a_msgs/msg/B", "a_msgs/C[] all\n====\nMSG: a_msgs/C\nfloat64[36] covariance\n");
  std::string message = R"({"all":[{})";
  for (int i = 0; i < 4000; ++i) message += ",{}";
  EXPECT_THAT(error_of(list, message + "]}"), HasSubstr("must have at most 1048576 bytes in CDR"));
}

TEST(RosJson, BytesOfAnotherTypeAreNull) {
  std::vector<std::byte> cdr;
  CdrWriter out(cdr);
  out.put(std::int8_t{1});
  std::string text = "x";
  EXPECT_FALSE(append_json(mixed(), view_of(cdr), text));
  EXPECT_EQ(text, "xnull");
}

}  // namespace
