// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/earlier_events.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace {

TEST(EarlierEvents, GoToEachPageThatConnects) {
  viewer::EarlierEvents events;
  events.add(R"({"who":"a"})");
  EXPECT_FALSE(events.text_for(0));
  EXPECT_TRUE(events.text_for(1));
  EXPECT_FALSE(events.text_for(1));
  // A page leaves and another connects between two calls.
  events.add(R"({"who":"b"})");
  events.page_left();
  const auto text = events.text_for(1);
  ASSERT_TRUE(text);
  EXPECT_EQ(nlohmann::json::parse(*text)["items"].size(), 2u);
}

TEST(EarlierEvents, AreTheLastThousandAndTheOthersAreCounted) {
  viewer::EarlierEvents events;
  for (int i = 0; i < 1200; ++i) events.add("{\"number\":" + std::to_string(i) + "}");
  const auto text = events.text_for(1);
  ASSERT_TRUE(text);
  const auto json = nlohmann::json::parse(*text);
  EXPECT_EQ(json["dropped"], 200);
  EXPECT_EQ(json["items"].size(), 1000u);
  EXPECT_EQ(json["items"][0]["number"], 200);
  EXPECT_EQ(json["all"], true);
}

}  // namespace
