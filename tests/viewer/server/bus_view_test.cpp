// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/bus_view.hpp"

#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"
#include "tests/viewer/server/served_bus.hpp"

namespace {

using namespace served_bus;

// The live page of what is on a bus.

using testing::HasSubstr;

TEST(BusView, ShowsTheSceneAndTheTimeOfTheRunOnTheBus) {
  const test::TrafficLog log;
  ServedBus bus;
  test::ViewPage page(bus.url());
  const auto first = page.text("hello");
  EXPECT_EQ(first["source"], "bus");
  EXPECT_EQ(first["name"], "udpm://bus");
  bus.play(log.path);
  EXPECT_EQ(page.text("hello")["world"], "fall") << "as soon as the run has said its name";
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "ball/body");
  const auto status = page.text("status", [](const auto& text) { return text["time_us"] == 10'000'000; });
  EXPECT_EQ(status["ended"], nullptr);
}

TEST(BusView, PassesOnTheMessagesOfSubscribedChannels) {
  const test::TrafficLog log;
  ServedBus bus;
  test::ViewPage page(bus.url());
  page.subscribe("ball.pose");
  // A wrong subscription is answered after the right one was taken.
  page.send({{"op", "subscribe"}, {"channels", 3}});
  EXPECT_THAT(page.text("error")["text"].get<std::string>(), HasSubstr("'channels' must be"));
  bus.play(log.path);
  const auto message = page.message([](const test::ViewMessage& one) { return one.time_us > 9'800'000; });
  EXPECT_EQ(message.header["channel"], "ball.pose");
  EXPECT_EQ(message.header["type"], "shoal.pose_t");
  const double utime = message.header["fields"]["utime"].get<double>();
  bool found = false;  // the pose is one of those that were published
  for (int step = 1; step <= 1000; ++step)
    found = found || message.header["fields"]["pos"][2] == test::TrafficLog::height(step);
  EXPECT_TRUE(found) << utime;
}

TEST(BusView, CountsMessagesAndSaysWhoHeardWhom) {
  const test::TrafficLog log;
  ServedBus bus;
  test::ViewPage page(bus.url());
  const std::int64_t poses = bus.play(log.path);
  EXPECT_EQ(poses, 1000);
  const auto count = [](const web_test::Json& channels) {
    for (const auto& item : channels["items"])
      if (item["name"] == "ball.pose") return item["count"].get<std::int64_t>();
    return std::int64_t{0};
  };
  page.text("channels", [&](const auto& channels) { return count(channels) == poses; });
  // Ten sounds, every second one lost.
  page.text("links", [](const auto& links) {
    return links["items"] ==
           web_test::Json::array(
               {{{"from", "a/modem"}, {"to", "b/modem"}, {"sent", 10}, {"received", 5}, {"lost", {{"noise", 5}}}}});
  });
}

TEST(BusView, RefusesToSteerAndSaysHow) {
  ServedBus bus;
  test::ViewPage page(bus.url());
  page.control("pause");
  const auto reply = page.reply();
  EXPECT_EQ(reply["ok"], false);
  EXPECT_THAT(reply["text"].get<std::string>(), HasSubstr("steer the run with 'shoal control'"));
}

}  // namespace
