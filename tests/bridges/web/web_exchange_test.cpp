// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/web_exchange.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace {

using testing::ElementsAre;

struct ExchangeBox : bridges::WebBox {
  std::vector<std::string> texts;
};
struct ExchangeRequest {
  int client = 0;
};
struct ExchangeSession {};

/// The exchange with a thread that works when the test says so.
class WebExchangeTest : public testing::Test {
 protected:
  void put(const std::string& text) {
    exchange_.put([&](ExchangeBox& box) { box.texts.push_back(text); });
  }
  void run() {
    for (const auto& work : std::exchange(posted_, {})) work();
  }

  std::vector<std::function<void()>> posted_;
  std::vector<std::string> delivered_;
  bridges::WebExchange<ExchangeBox, ExchangeRequest, ExchangeSession> exchange_{
      [this](ExchangeBox box) { delivered_ = std::move(box.texts); }, 2,
      [this](std::function<void()> work) { posted_.push_back(std::move(work)); }};
};

TEST_F(WebExchangeTest, TheThreadIsWokenOnceForAllThatWaits) {
  put("a");
  put("b");
  EXPECT_EQ(posted_.size(), 1u);
  run();
  EXPECT_THAT(delivered_, ElementsAre("a", "b"));
  put("c");
  run();
  EXPECT_THAT(delivered_, ElementsAre("c"));
}

TEST_F(WebExchangeTest, WhatFoundNoRoomWakesNothing) {
  exchange_.put([](ExchangeBox&) { return false; });
  EXPECT_TRUE(posted_.empty());
}

TEST_F(WebExchangeTest, TheQuotaIsThatOfOneClient) {
  EXPECT_TRUE(exchange_.add_request({1}));
  EXPECT_TRUE(exchange_.add_request({1}));
  EXPECT_FALSE(exchange_.add_request({1}));
  EXPECT_TRUE(exchange_.add_request({2}));
  EXPECT_TRUE(exchange_.add_request({1}, true)) << "that it has left";
  for (const int client : {1, 1, 2, 1}) EXPECT_EQ(exchange_.take_request().value().client, client);
  EXPECT_FALSE(exchange_.take_request());
  EXPECT_TRUE(exchange_.add_request({1})) << "again, after its requests were taken";
}

TEST(WebQueue, KnowsTheBytesOfWhatWaits) {
  bridges::WebQueue<std::string> queue;
  for (const std::string text : {"one", "three", "fifteen"}) queue.push(text, text.size());
  EXPECT_EQ(queue.bytes(), 15u);
  queue.remove([](const std::string& text) { return text == "three"; });
  EXPECT_EQ(queue.bytes(), 10u);
  EXPECT_EQ(queue.pop(), "one");
  EXPECT_EQ(queue.bytes(), 7u);
  queue.clear();
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.bytes(), 0u);
}

}  // namespace
