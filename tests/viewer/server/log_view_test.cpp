// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/log_view.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <optional>
#include <random>

#include "bridges/log/record_file.hpp"
#include "experiment/replay/replay.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "tests/viewer/server/log_page.hpp"

// A log that is played, and another one beside it.

namespace {

using testing::HasSubstr;

TEST(LogIndex, KnowsTheSpanAndTheEventsOfALog) {
  const test::FallLog log;
  const viewer::LogIndex index(log.path);
  EXPECT_EQ(index.start_us(), 0);
  EXPECT_EQ(index.end_us(), 3'000'000);
  EXPECT_EQ(index.world(), "fall");
  ASSERT_GE(index.occasions().size(), 1u);
  EXPECT_EQ(index.occasions()[0].who, "half");
  EXPECT_NEAR(static_cast<double>(index.occasions()[0].time_us), 1e6, 1e4);
}

TEST(LogIndex, SaysWhatALogLacks) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("empty.lcm");
  { test::RecordedRun run("shoal: 1\n", path); }
  try {
    const viewer::LogIndex index(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("empty.lcm: has neither sim.scene nor sim.bodies"));
    EXPECT_THAT(error.what(), HasSubstr("`shoal view " + path + " --resimulate` runs its world again, and shows it"));
  }
}

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

/// Logs with hashes, as `shoal run` writes them, differ where their hashes do.
class LogDifference : public testing::Test {
 protected:
  static std::string world(double z_m) {
    return "shoal: 1\nrun: {hash_every_steps: 10}\nphysics: {step_s: 0.01}\nobjects: [{name: ball, parts: [{shape: "
           "sphere, mass_kg: 1}], position_m: [0, 0, " +
           std::to_string(z_m) + "]}]\n";
  }
  /// Records a second; `lift_at`: step at which a client moves the ball.
  std::string record(const std::string& name, double z_m, std::int64_t lift_at = -1) {
    test::RecordedRun run(world(z_m), folder_.file(name));
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    run.run(100, [&](std::int64_t step) {
      if (step == lift_at) run.request("do", "{move: {name: ball, position_m: [0, 0, 9]}}");
    });
    return folder_.file(name);
  }

  test_support::ScratchFolder folder_;
};

TEST_F(LogDifference, IsTheFirstHashThatDiffers) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 1, 52);
  const auto difference = viewer::first_difference(a, viewer::LogIndex(a), b, viewer::LogIndex(b));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->by, "sim.hash");
  EXPECT_EQ(difference->step, 60);
  EXPECT_EQ(difference->time_us, 600'000);
}

TEST_F(LogDifference, IsThatOfAReplay) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 2);
  const auto difference = viewer::first_difference(a, viewer::LogIndex(a), b, viewer::LogIndex(b));
  ASSERT_TRUE(difference);
  // The log of b in the world of a.
  experiment::ReplayOptions options;
  options.log = b;
  options.world = folder_.file("a.yaml");
  std::ofstream(options.world) << world(1);
  options.quiet = true;
  const experiment::ReplayOutcome replayed = experiment::replay(options);
  ASSERT_TRUE(replayed.first);
  EXPECT_EQ(replayed.first->step, *difference->step);
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

}  // namespace
