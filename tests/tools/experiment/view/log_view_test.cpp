// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/view/log_view.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

#include "bridges/view/view_publisher.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/experiment/replay/recorded_run.hpp"
#include "tools/experiment/replay/replay.hpp"

namespace {

using testing::HasSubstr;

/// A log of a ball that falls for three seconds, from 100 m, with an event after one.
struct Log {
  explicit Log(const std::string& more = "") {
    test::RecordedRun run(
        "shoal: 1\nname: fall\nphysics: {step_s: 0.01}\nobjects: [{name: ball, position_m: [1, 2, 100], parts: "
        "[{shape: "
        "sphere, mass_kg: 1}]}]\nevents: [{name: half, at: 1, do: [{log: one second}]}" +
            more + "]\n",
        path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 0; i < 300; ++i) {
      run.world.step();
      view.after_step();
    }
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

/// State frame of the page protocol.
struct State {
  std::uint8_t flags;
  std::int64_t time_us;
  std::uint32_t count;
  float z_m;
  explicit State(const std::string& frame) {
    flags = static_cast<std::uint8_t>(frame[1]);
    std::memcpy(&time_us, frame.data() + 8, 8);
    std::memcpy(&count, frame.data() + 24, 4);
    std::memcpy(&z_m, frame.data() + 32 + 8, 4);
  }
};

/// A page of the log, served in another thread.
struct Page {
  explicit Page(const Log& log, const std::function<void(tools::LogView&)>& prepare = {})
      : index(log.path), view(log.path, index, options(), "test"), client(port()) {
    if (prepare) prepare(view);
    thread = std::thread([this] {
      while (!end) {
        view.advance(0.01);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    client.upgrade();
    const std::string url = view.url();
    client.send_json({{"op", "hello"}, {"token", url.substr(url.find("#t=") + 3)}});
  }
  ~Page() {
    end = true;
    thread.join();
  }
  static tools::ViewOptions options() {
    tools::ViewOptions options;
    options.port = 0;
    return options;
  }
  std::uint16_t port() const {
    const std::string url = view.url();
    const std::size_t colon = url.rfind(':');
    return static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1)));
  }
  /// Reads up to the next text of a kind.
  web_test::Json text(const std::string& op) {
    while (const auto frame = client.read_frame())
      if (frame->is_text() && frame->json()["op"] == op) return frame->json();
    throw std::runtime_error("no '" + op + "'");
  }
  /// Pauses the log, so that a state is that of the time sought, however busy the machine is.
  void pause() {
    client.send_json({{"op", "play"}, {"paused", true}});
    while (!text("status").value("paused", false)) {
    }
  }
  /// Reads the next state, and acknowledges one that was not asked for.
  State next_state() {
    while (const auto frame = client.read_frame()) {
      if (frame->is_text()) continue;
      const State state(frame->payload);
      std::uint32_t sequence = 0;
      std::memcpy(&sequence, frame->payload.data() + 4, 4);
      if ((state.flags & 4) == 0) client.send_json({{"op", "ack"}, {"sequence", sequence}});
      return state;
    }
    throw std::runtime_error("no state");
  }
  /// Reads up to the state after a jump to a time, at most 0.1 s before it.
  State state_after_seek(std::int64_t time_us) {
    client.send_json({{"op", "seek"}, {"time_us", time_us}});
    for (;;) {
      const State state = next_state();
      if ((state.flags & 2) != 0 && state.time_us <= time_us && time_us - state.time_us <= 100'000) return state;
    }
  }

  tools::LogIndex index;
  tools::LogView view;
  web_test::Client client;
  std::atomic<bool> end = false;
  std::thread thread;
};

TEST(LogIndex, KnowsTheSpanAndTheEventsOfALog) {
  const Log log;
  const tools::LogIndex index(log.path);
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
    const tools::LogIndex index(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("empty.lcm: has neither sim.scene nor sim.bodies"));
  }
}

TEST(LogView, IntroducesTheLogAndItsScene) {
  const Log log;
  Page page(log);
  const auto hello = page.text("hello");
  EXPECT_EQ(hello["source"], "log");
  EXPECT_EQ(hello["name"], "run.lcm");
  EXPECT_EQ(hello["end_us"], 3'000'000);
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "ball/body");
}

/// z = 100 m - g t^2 / 2; the step of 10 ms is of first order: it adds at most g t h / 2.
TEST(LogView, ASeekShowsThePosesOfThatTime) {
  const Log log;
  Page page(log);
  page.pause();
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const std::int64_t time_us = random() % 3'000'000;
    const State state = page.state_after_seek(time_us);
    const double t_s = static_cast<double>(state.time_us) / 1e6;
    EXPECT_EQ(state.count, 1u);
    EXPECT_LE(state.time_us, time_us);
    EXPECT_NEAR(state.z_m, 100 - 9.80665 * t_s * t_s / 2, 9.80665 * t_s * 0.01 / 2 + 1e-4);
  }
}

/// In the second log the ball is put 50 m higher after two seconds.
TEST(LogView, ShowsASecondLogAtTheSameTimeAndWhereItDiffers) {
  const Log log, other(", {name: lift, at: 2, do: [{move: {name: ball, position_m: [1, 2, 150]}}]}");
  const tools::LogIndex a(log.path), b(other.path);
  EXPECT_FALSE(tools::first_difference(log.path, a, log.path, a));
  const auto difference = tools::first_difference(log.path, a, other.path, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->by, "poses");
  EXPECT_GE(difference->time_us, 2'000'000);
  EXPECT_LE(difference->time_us, 2'100'000);
  Page page(log, [&](tools::LogView& view) { view.compare_with(other.path, b, difference); });
  page.pause();
  const auto look = [&](int branch, std::int64_t time_us) {
    page.client.send_json({{"op", "look"}, {"branch", branch}, {"time_us", time_us}});
    for (;;)
      if (const State state = page.next_state(); (state.flags & 4) != 0) return state;
  };
  EXPECT_EQ(look(0, 1'500'000).z_m, look(1, 1'500'000).z_m);
  EXPECT_GT(look(1, 2'500'000).z_m, 100);
  EXPECT_LT(look(0, 2'500'000).z_m, 90);
  EXPECT_EQ(look(1, 2'500'000).count, 1u);
  page.client.send_json({{"op", "look"}, {"branch", 2}, {"time_us", 0}});
  EXPECT_EQ(page.text("error")["text"], "look: there is no log 2");
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
  const auto difference = tools::first_difference(a, tools::LogIndex(a), b, tools::LogIndex(b));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->by, "sim.hash");
  EXPECT_EQ(difference->step, 60);
  EXPECT_EQ(difference->time_us, 600'000);
}

TEST_F(LogDifference, IsThatOfAReplay) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 2);
  const auto difference = tools::first_difference(a, tools::LogIndex(a), b, tools::LogIndex(b));
  ASSERT_TRUE(difference);
  // The log of b in the world of a.
  tools::ReplayOptions options;
  options.log = b;
  options.world = folder_.file("a.yaml");
  std::ofstream(options.world) << world(1);
  options.quiet = true;
  const tools::ReplayOutcome replayed = tools::replay(options);
  ASSERT_TRUE(replayed.first);
  EXPECT_EQ(replayed.first->step, *difference->step);
}

TEST(LogView, RefusesToSteer) {
  const Log log;
  Page page(log);
  page.client.send_json({{"op", "control"}, {"id", 7}, {"command", "pause"}});
  const auto reply = page.text("reply");
  EXPECT_EQ(reply["id"], 7);
  EXPECT_EQ(reply["ok"], false);
}

}  // namespace
