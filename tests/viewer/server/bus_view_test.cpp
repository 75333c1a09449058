// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/bus_view.hpp"

#include <gmock/gmock.h>

#include <mutex>

#include "tests/viewer/server/log_page.hpp"

// The live page of what is on a bus.

namespace {

using testing::HasSubstr;

/// The page of a bus, served in another thread.  The test puts messages on the bus.
class ServedBus {
 public:
  ServedBus() : view_(test::LogPage::options(), "test", "udpm://bus") {
    thread_ = std::thread([this] {
      while (!end_) {
        {
          const std::lock_guard lock(mutex_);
          view_.flush();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~ServedBus() {
    end_ = true;
    thread_.join();
  }
  std::string url() const { return view_.url(); }
  void publish(const std::string& channel, std::span<const std::byte> payload) {
    const std::lock_guard lock(mutex_);
    view_.message(channel, payload);
  }
  /// Puts the messages of a log on the bus, as fast as possible.  Returns the number of those on `ball.pose`.
  std::int64_t play(const std::string& log) {
    bridges::EventLogReader reader(log);
    std::int64_t poses = 0;
    while (const auto event = reader.next()) {
      publish(event->channel, event->payload);
      poses += event->channel == "ball.pose";
    }
    return poses;
  }

 private:
  std::mutex mutex_;
  viewer::BusView view_;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

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

/// A viewer may join the playback of a log at any time.
TEST(BusView, SaysThatItWaitsForTheScene) {
  ServedBus bus;
  test::ViewPage page(bus.url());
  EXPECT_EQ(page.text("status")["waits_for"], "waits for sim.scene");
  const test::TrafficLog log;
  bus.play(log.path);
  page.text("status", [](const auto& text) { return text["waits_for"] == ""; });
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

/// On another channel a pose may be a goal.
TEST(BusView, TakesAPoseForAnEstimateOnVehicleEstimate) {
  ServedBus bus;
  test::ViewPage page(bus.url());
  page.text("hello");
  shoal::pose_t pose{};
  pose.utime = 5'000'000;
  pose.pos[0] = 1;
  pose.orientation[0] = pose.orientation[3] = std::sqrt(0.5);  // 90 degrees to the left
  bus.publish("r2.goal", shoal::encode(pose));
  bus.publish("r1.estimate", shoal::encode(pose));
  const auto items = page.text("estimates")["items"];
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0]["vehicle"], "r1");
  EXPECT_EQ(items[0]["time_us"], 5'000'000);
  EXPECT_EQ(items[0]["pose"][0], 1);
  EXPECT_NEAR(items[0]["pose"][6].get<double>(), std::sqrt(0.5), 1e-12);
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

TEST(BusView, APageThatConnectsAgainGetsAllThatHolds) {
  const test::TrafficLog log;
  ServedBus bus;
  {
    test::ViewPage before(bus.url());
    bus.play(log.path);
    before.text("status", [](const auto& text) { return text["time_us"] == 10'000'000; });
  }
  // Nothing more comes on the bus.
  test::ViewPage page(bus.url());
  EXPECT_EQ(page.text("hello")["world"], "fall");
  page.text("status", [](const auto& text) { return text["time_us"] == 10'000'000; });
  const test::ViewState state = page.state();
  EXPECT_EQ(state.count, 1u);
  EXPECT_EQ(state.time_us, 10'000'000);
  EXPECT_EQ(test::ViewPage(bus.url()).text("scene")["bodies"][0]["name"], "ball/body");
  test::ViewPage(bus.url()).text(
      "links", [](const auto& links) { return links["items"].size() == 1 && links["items"][0]["received"] == 5; });
}

TEST(BusView, AnotherRunOnTheBusBringsItsOwnScene) {
  const test::TrafficLog log;
  const test_support::ScratchFolder folder;
  {
    test::RecordedRun run(
        "shoal: 1\nname: other\nobjects: [{name: cube, position_m: [0, 0, 5], parts: [{shape: box, mass_kg: 1}]}]\n",
        folder.file("other.lcm"));
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
  }
  ServedBus bus;
  test::ViewPage page(bus.url());
  bus.play(log.path);
  EXPECT_EQ(page.text("scene")["world"], "fall");
  bus.play(folder.file("other.lcm"));
  EXPECT_EQ(page.text("hello", [](const auto& hello) { return hello["world"] != "fall"; })["world"], "other");
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "cube/body");
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
