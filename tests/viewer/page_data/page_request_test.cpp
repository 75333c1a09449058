// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/page_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using viewer::Subscription;
using Json = nlohmann::json;

std::string error_of_subscribe(const std::string& text) {
  try {
    viewer::parse_subscribe(text);
  } catch (const viewer::PageRequestError& error) {
    return error.what();
  }
  return "";
}

std::string error_of_series(const Json& change) {
  Json request{{"id", 1}, {"channel", "a"}, {"field", "b"}, {"from_us", 0}, {"to_us", 10}, {"points", 100}};
  request.merge_patch(change);
  try {
    viewer::parse_series(request.dump());
  } catch (const viewer::PageRequestError& error) {
    return error.what();
  }
  return "";
}

TEST(PageRequest, ASubscriptionNamesChannelsWithTheirRates) {
  EXPECT_THAT(viewer::parse_subscribe(R"({"channels":[{"name":"a.imu","rate_hz":5},{"name":"b","rate_hz":0.5}]})"),
              ElementsAre(Subscription{"a.imu", 5}, Subscription{"b", 0.5}));
}

TEST(PageRequest, OfTwoEntriesOfAChannelTheLastCounts) {
  EXPECT_THAT(viewer::parse_subscribe(R"({"channels":[{"name":"a","rate_hz":5},{"name":"a","rate_hz":7}]})"),
              ElementsAre(Subscription{"a", 7}));
}

TEST(PageRequest, AnInvalidSubscriptionSaysWhere) {
  EXPECT_EQ(error_of_subscribe("{}"), "subscribe: 'channels' must be a list of {name, rate_hz}");
  EXPECT_EQ(error_of_subscribe(R"({"channels":[{"name":"a"},3]})"),
            "subscribe: channels[1] must be an object {name, rate_hz}");
  EXPECT_EQ(error_of_subscribe(R"({"channels":[{"name":""}]})"),
            "subscribe: channels[0]: 'name' must be a text of 1 to 63 bytes");
  EXPECT_EQ(error_of_subscribe(R"({"channels":[{"name":"a","rate_hz":31}]})"),
            "subscribe: channels[0]: 'rate_hz' must be above 0 and at most 30, got 31");
  EXPECT_THAT(error_of_subscribe(R"({"channels":[{"name":"a","rate_hz":0}]})"), HasSubstr("got 0"));
  EXPECT_THAT(error_of_subscribe(R"({"channels":[{"name":"a","rate_hz":"x"}]})"), HasSubstr("must be a number"));
}

TEST(PageRequest, APageHasAtMost256Channels) {
  Json channels = Json::array();
  for (int i = 0; i < 257; ++i) channels.push_back({{"name", std::to_string(i)}});
  EXPECT_EQ(error_of_subscribe(Json{{"channels", channels}}.dump()),
            "subscribe: at most 256 channels for a page, got 257");
}

TEST(PageRequest, AnInvalidSeriesSaysWhatIsWrong) {
  EXPECT_EQ(error_of_series(Json::object()), "");
  EXPECT_EQ(error_of_series({{"from_us", 11}}), "series: 'from_us' 11 is after 'to_us' 10");
  EXPECT_EQ(error_of_series({{"points", 4001}}), "series: 'points' must be an integer from 2 to 4000, got 4001");
  EXPECT_EQ(error_of_series({{"field", std::string(257, 'x')}}), "series: 'field' must be a text of 1 to 256 bytes");
  EXPECT_EQ(error_of_series({{"channel", nullptr}}), "series: 'channel' must be a text of 1 to 63 bytes");
}

std::string error_of(const std::string& text) {
  try {
    viewer::parse_look(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(LookRequest, NamesATimeOfABranch) {
  const viewer::LookRequest request = viewer::parse_look(R"({"time_us": 1500000, "branch": 2})");
  EXPECT_EQ(request.time_us, 1'500'000);
  EXPECT_EQ(request.branch, 2);
  EXPECT_EQ(viewer::parse_look(R"({"time_us": -2.5})").time_us, -3);  // at or before it
}

TEST(LookRequest, WithoutATimeThePageShowsThePresent) {
  const viewer::LookRequest request = viewer::parse_look(R"({"time_us": null, "branch": null})");
  EXPECT_FALSE(request.time_us);
  EXPECT_FALSE(request.branch);
}

TEST(LookRequest, SaysWhatIsWrong) {
  EXPECT_EQ(error_of("[1]"), "look: must be a JSON object");
  EXPECT_EQ(error_of("{"), "look: must be a JSON object");
  EXPECT_EQ(error_of("{}"), "look: 'time_us' is missing");
  EXPECT_EQ(error_of(R"({"time_us": "now"})"),
            R"(look: 'time_us' must be null or a number from -1e18 to 1e18, got "now")");
  EXPECT_EQ(error_of(R"({"time_us": 2e18})"), "look: 'time_us' must be null or a number from -1e18 to 1e18, got 2e+18");
  EXPECT_EQ(error_of(R"({"time_us": 0, "branch": -1})"), "look: 'branch' must be the number of a branch, got -1");
  EXPECT_EQ(error_of(R"({"time_us": 0, "branch": 3000000000})"),
            "look: 'branch' must be the number of a branch, got 3000000000");
  EXPECT_EQ(error_of(R"({"time_us": 0, "branch": 0.5})"), "look: 'branch' must be the number of a branch, got 0.5");
}

}  // namespace
