// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/log_view.hpp"

#include <gmock/gmock.h>

#include <optional>
#include <random>

#include "bridges/log/record_file.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/viewer/server/log_page.hpp"

namespace {

// A log that is played, and another one beside it.

/// The log of a logger that was started a second after the run: its `sim.info` and `sim.scene` come after ten seconds.
struct LateLog {
  LateLog() {
    test::TrafficLog log;
    bridges::EventLogReader reader(log.path);
    bridges::EventLogWriter writer(bridges::create_record_file(path, bridges::Existing::refuse));
    std::optional<bridges::LogEvent> info;
    std::int64_t number = 0;
    while (const auto event = reader.next()) {
      if (!info && event->channel == "sim.info") info = event;
      if (!info || event->utime <= info->utime + 1'000'000) continue;
      if (event->channel == "sim.scene") writer.write(number++, event->utime, info->channel, info->payload);
      writer.write(number++, event->utime, event->channel, event->payload);
    }
    writer.flush();
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("late.lcm");
};

TEST(LogView, ShowsALogThatLacksItsStart) {
  const LateLog log;
  test::LogPage page(log);
  EXPECT_NEAR(static_cast<double>(page.index.start_us()), 1e6, 1e5);
  EXPECT_EQ(page.index.end_us(), 10'000'000);
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "ball/body");
  page.pause();
  EXPECT_EQ(page.state_after_seek(5'000'000).count, 1u);
}

TEST(LogView, IntroducesTheLogAndItsScene) {
  const test::FallLog log;
  test::LogPage page(log);
  const auto hello = page.text("hello");
  EXPECT_EQ(hello["source"], "log");
  EXPECT_EQ(hello["name"], "run.lcm");
  EXPECT_EQ(hello["end_us"], 3'000'000);
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "ball/body");
}

/// z = 100 m - g t^2 / 2; the step of 10 ms is of first order: it adds at most g t h / 2.
TEST(LogView, ASeekShowsThePosesOfThatTime) {
  const test::FallLog log;
  test::LogPage page(log);
  page.pause();
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const std::int64_t time_us = random() % 3'000'000;
    const test::ViewState state = page.state_after_seek(time_us);
    const double t_s = static_cast<double>(state.time_us) / 1e6;
    EXPECT_EQ(state.count, 1u);
    EXPECT_LE(state.time_us, time_us);
    EXPECT_NEAR(state.z_m, 100 - 9.80665 * t_s * t_s / 2, 9.80665 * t_s * 0.01 / 2 + 1e-4);
  }
}

/// In the second log the ball is put 50 m higher after two seconds.
TEST(LogView, ShowsASecondLogAtTheSameTimeAndWhereItDiffers) {
  const test::FallLog log, other(", {name: lift, at: 2, do: [{move: {name: ball, position_m: [1, 2, 150]}}]}");
  const viewer::LogIndex a(log.path), b(other.path);
  EXPECT_FALSE(viewer::first_difference(log.path, a, log.path, a));
  const auto difference = viewer::first_difference(log.path, a, other.path, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->by, "poses");
  EXPECT_GE(difference->time_us, 2'000'000);
  EXPECT_LE(difference->time_us, 2'100'000);
  test::LogPage page(log, [&](viewer::LogView& view) { view.compare_with(other.path, b, difference); });
  page.pause();
  const auto look = [&](int branch, std::int64_t time_us) {
    page.client.send_json({{"op", "look"}, {"branch", branch}, {"time_us", time_us}});
    for (;;)
      if (const test::ViewState state = page.next_state(); state.past()) return state;
  };
  EXPECT_EQ(look(0, 1'500'000).z_m, look(1, 1'500'000).z_m);
  EXPECT_GT(look(1, 2'500'000).z_m, 100);
  EXPECT_LT(look(0, 2'500'000).z_m, 90);
  EXPECT_EQ(look(1, 2'500'000).count, 1u);
  page.client.send_json({{"op", "look"}, {"branch", 2}, {"time_us", 0}});
  EXPECT_EQ(page.text("error")["text"], "look: there is no log 2");
}

/// Of the first log they come as it is played, of the second one with its poses.
TEST(LogView, SendsTheEstimatesOfBothLogs) {
  const test::FallLog log("", 1.5), other("", 3);
  const viewer::LogIndex b(other.path);
  test::LogPage page(log, [&](viewer::LogView& view) { view.compare_with(other.path, b, std::nullopt); });
  page.pause();
  page.seek(2'000'000);
  const auto own = page.text_when("estimates", [](const web_test::Json& text) {
    return !text.contains("branch") && text["items"][0]["time_us"] == 2'000'000;
  });
  EXPECT_EQ(own["items"][0]["pose"], web_test::Json({1.5, 0, 0, 1, 0, 0, 0}));
  EXPECT_FALSE(own["items"][0].contains("covariance_m2")) << "a pose has none";
  const auto look = [&](std::int64_t time_us) {
    page.client.send_json({{"op", "look"}, {"branch", 1}, {"time_us", time_us}});
    return page.text_when("estimates", [](const web_test::Json& text) { return text.contains("branch"); });
  };
  const auto others = look(1'050'000);
  EXPECT_EQ(others["branch"], 1);
  ASSERT_EQ(others["items"].size(), 1u);
  EXPECT_EQ(others["items"][0]["vehicle"], "ball");
  EXPECT_EQ(others["items"][0]["time_us"], 1'000'000);
  EXPECT_EQ(others["items"][0]["pose"][0], 3);
  EXPECT_TRUE(look(50'000)["items"].empty()) << "before the first one";
}

/// A log of ten seconds with a path to x = k m after k seconds, for k = 1 and 9.
struct PathLog {
  PathLog() {
    test::RecordedRun run(test::falling_ball() + "\n", path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 1; i <= 1000; ++i) {
      run.world.step();
      if (i == 100 || i == 900) publish(run, i / 100);
      view.after_step();
    }
  }
  static void publish(test::RecordedRun& run, double x_m) {
    const sim::Time now = run.world.now();
    run.recorder.set_time(now);
    shoal::waypoints_command_t path{};
    path.utime = run.world.epoch_us() + now.count();
    path.n = 1;
    path.x_m = {x_m};
    path.y_m = path.depth_m = {0};
    run.gate.publish("ball.path", shoal::encode(path), now);
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

TEST(LogView, ASeekShowsThePathThatHeldThenHoweverOldItWas) {
  const PathLog log;
  test::LogPage page(log);
  page.pause();
  const auto end_after_seek = [&](std::int64_t time_us, double expected) {
    page.seek(time_us);
    const auto text = page.text_when("paths", [&](const web_test::Json& paths) {
      return paths["items"].empty() ? expected == 0 : paths["items"][0]["points"][0][0] == expected;
    });
    return !text.is_null();
  };
  EXPECT_TRUE(end_after_seek(8'900'000, 1));  // of 7.9 s before
  EXPECT_TRUE(end_after_seek(9'500'000, 9));
  EXPECT_TRUE(end_after_seek(500'000, 0));
  EXPECT_TRUE(end_after_seek(2'000'000, 1));
}

TEST(LogView, RefusesToSteer) {
  const test::FallLog log;
  test::LogPage page(log);
  page.client.send_json({{"op", "control"}, {"id", 7}, {"command", "pause"}});
  const auto reply = page.text("reply");
  EXPECT_EQ(reply["id"], 7);
  EXPECT_EQ(reply["ok"], false);
}

TEST(LogView, CountsMessagesUpToTheTimeShown) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.pause();
  for (const std::int64_t time_us : {9'500'000, 500'000, 5'500'000}) {
    page.seek(time_us);
    const auto json = page.text_when("channels", [&](const auto& channels) { return channels["time_us"] == time_us; });
    std::int64_t count = 0;
    for (const auto& item : json["items"])
      if (item["name"] == "ball.pose") {
        count = item["count"];
        EXPECT_EQ(item["type"], "shoal.pose_t");
        EXPECT_EQ(item["bytes"], count * 144);
      }
    // Up to the last poses of the bodies at this time, some thirty per second.
    EXPECT_NEAR(static_cast<double>(count), static_cast<double>(time_us) / 10'000, 5);
  }
}

TEST(LogView, SaysWhoHeardWhomUpToTheTimeShown) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.pause();
  for (const int seconds : {9, 0, 4}) {
    const std::int64_t time_us = seconds * 1'000'000 + 500'000;
    page.seek(time_us);
    const auto json = page.text_when("links", [&](const auto& links) { return links["time_us"] == time_us; });
    if (seconds == 0) {
      EXPECT_TRUE(json["items"].empty());
      continue;
    }
    const int lost = seconds / 2;
    EXPECT_EQ(json["items"], web_test::Json::array({{{"from", "a/modem"},
                                                     {"to", "b/modem"},
                                                     {"sent", seconds},
                                                     {"received", seconds - lost},
                                                     {"lost", {{"noise", lost}}}}}));
  }
}

}  // namespace
