// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"
#include "tests/viewer/server/served_bus.hpp"

namespace {

using namespace served_bus;

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

TEST(BusView, APageThatConnectsAgainGetsAllThatHolds) {
  const test::TrafficLog log;
  ServedBus bus;
  {
    test::ViewPage before(bus.url());
    bus.play(log.path);
    before.text("status", [](const auto& text) { return text["time_us"] == 10'000'000; });
  }
  // Nothing more arrives on the bus.
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

}  // namespace
