// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/view/log_view.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

#include "bridges/view/view_publisher.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_sound_arrival_t.hpp"
#include "shoal/sim_sound_t.hpp"
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

/// The same log, with a pose of the ball on `ball.pose` each step, its height in `pos[2]`, and sounds from a to b: the
/// k-th in the step 100 k, of which every second one is lost.
struct TrafficLog {
  TrafficLog() {
    test::RecordedRun run(
        "shoal: 1\nname: fall\nphysics: {step_s: 0.01}\nobjects: [{name: ball, position_m: [1, 2, 100], parts: "
        "[{shape: "
        "sphere, mass_kg: 1}]}]\n",
        path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 1; i <= 1000; ++i) {
      run.world.step();
      publish(run, i);
      view.after_step();
    }
  }
  static void publish(test::RecordedRun& run, int step) {
    const sim::Time now = run.world.now();
    run.recorder.set_time(now);
    shoal::pose_t pose{};
    pose.utime = run.world.epoch_us() + now.count();
    pose.pos[2] = height(step);
    run.gate.publish("ball.pose", shoal::encode(pose), now);
    if (step % 100 != 0) return;
    shoal::sim_sound_t sound{};
    sound.utime = pose.utime;
    sound.source = "a/modem";
    sound.kind = "message";
    sound.sequence = step / 100;
    run.gate.publish("sim.sound", shoal::encode(sound), now);
    shoal::sim_sound_arrival_t arrival{};
    arrival.utime = pose.utime;
    arrival.source = "a/modem";
    arrival.receiver = "b/modem";
    arrival.outcome = step % 200 == 0 ? "noise" : "received";
    run.gate.publish("sim.sound.arrival", shoal::encode(arrival), now);
  }
  static double height(int step) { return 50 * std::sin(0.37 * step); }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

/// Message frame of the page protocol.
struct Message {
  std::int64_t time_us = 0;
  web_test::Json header;
  explicit Message(const std::string& frame) {
    std::uint32_t size = 0;
    std::memcpy(&size, frame.data() + 4, 4);
    std::memcpy(&time_us, frame.data() + 8, 8);
    header = web_test::Json::parse(frame.substr(32, size));
  }
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
  template <typename AnyLog>
  explicit Page(const AnyLog& log, const std::function<void(tools::LogView&)>& prepare = {})
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
  /// Reads the next frame; nothing at the end of the connection.  The test may take twenty seconds: the status comes
  /// again and again.
  std::optional<web_test::Frame> frame() {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("what the test waits for has not come");
    return client.read_frame();
  }
  /// Reads up to the next text of a kind.
  web_test::Json text(const std::string& op) {
    while (const auto frame = this->frame())
      if (frame->is_text() && frame->json()["op"] == op) return frame->json();
    throw std::runtime_error("no '" + op + "'");
  }
  /// Pauses the log, so that a state is that of the time sought, however busy the machine is.
  void pause() {
    client.send_json({{"op", "play"}, {"paused", true}});
    while (!text("status").value("paused", false)) {
    }
  }
  /// Reads up to the text of a kind that satisfies a condition.
  template <typename Condition>
  web_test::Json text_when(const std::string& op, const Condition& condition) {
    for (;;) {
      const web_test::Json json = text(op);
      if (json.is_null() || condition(json)) return json;
    }
  }
  void subscribe(const std::string& channel, double rate_hz = 30) {
    client.send_json({{"op", "subscribe"}, {"channels", {{{"name", channel}, {"rate_hz", rate_hz}}}}});
  }
  /// Reads up to the next message.
  Message message() {
    while (const auto frame = this->frame())
      if (!frame->is_text() && frame->payload[0] == 2) return Message(frame->payload);
    throw std::runtime_error("no message");
  }
  void seek(std::int64_t time_us) { client.send_json({{"op", "seek"}, {"time_us", time_us}}); }
  web_test::Json series(std::int64_t from_us, std::int64_t to_us, int points, const std::string& field = "pos[2]") {
    client.send_json({{"op", "series"},
                      {"id", 5},
                      {"channel", "ball.pose"},
                      {"field", field},
                      {"from_us", from_us},
                      {"to_us", to_us},
                      {"points", points}});
    while (const auto frame = client.read_frame())
      if (frame->is_text() && (frame->json()["op"] == "series" || frame->json()["op"] == "reply")) return frame->json();
    return {};
  }
  /// Reads the next state, and acknowledges one that was not asked for.
  State next_state() {
    while (const auto frame = client.read_frame()) {
      if (frame->is_text() || frame->payload[0] != 1) continue;
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
  const std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
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

TEST(LogView, ASeekSendsTheLastMessageOfASubscribedChannel) {
  const TrafficLog log;
  Page page(log);
  page.pause();
  page.subscribe("ball.pose");
  for (const std::int64_t time_us : {5'000'000, 1'000'000, 9'000'000}) {
    page.seek(time_us);
    Message message = page.message();
    while (std::abs(message.time_us - time_us) > 100'000) message = page.message();
    EXPECT_LE(message.time_us, time_us);
    EXPECT_EQ(message.header["channel"], "ball.pose");
    EXPECT_EQ(message.header["type"], "shoal.pose_t");
    EXPECT_DOUBLE_EQ(message.header["fields"]["pos"][2].get<double>(),
                     TrafficLog::height(static_cast<int>(message.time_us / 10'000)));
  }
}

TEST(LogView, ASubscriptionIsAnsweredWhileTheLogIsPaused) {
  const TrafficLog log;
  Page page(log);
  page.pause();
  page.state_after_seek(4'000'000);
  page.subscribe("ball.pose", 1);
  EXPECT_NEAR(static_cast<double>(page.message().time_us), 4e6, 1e5);
}

TEST(LogView, AnInvalidSubscriptionIsAnError) {
  const TrafficLog log;
  Page page(log);
  page.subscribe("ball.pose", 1000);
  EXPECT_THAT(page.text("error")["text"].get<std::string>(), HasSubstr("'rate_hz' must be above 0 and at most 30"));
}

TEST(LogView, CountsMessagesUpToTheTimeShown) {
  const TrafficLog log;
  Page page(log);
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
  const TrafficLog log;
  Page page(log);
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

TEST(LogView, ASeriesHasEveryValueOfTheLog) {
  const TrafficLog log;
  Page page(log);
  const auto series = page.series(1'000'000, 2'000'000, 4000);
  EXPECT_EQ(series["id"], 5);
  ASSERT_EQ(series["values"].size(), 101u);
  for (std::size_t i = 0; i < 101; ++i) {
    EXPECT_EQ(series["t_us"][i], 1'000'000 + 10'000 * static_cast<int>(i));
    EXPECT_EQ(series["values"][i], TrafficLog::height(100 + static_cast<int>(i)));
  }
}

TEST(LogView, ALongSeriesKeepsTheExtremesInAtMostThePointsAskedFor) {
  const TrafficLog log;
  Page page(log);
  const auto series = page.series(0, 10'000'000, 20);
  EXPECT_LE(series["values"].size(), 20u);
  EXPECT_GE(series["values"].size(), 10u);
  double largest = -1e9, smallest = 1e9, shown_largest = -1e9, shown_smallest = 1e9;
  for (int i = 1; i <= 1000; ++i) {
    largest = std::max(largest, TrafficLog::height(i));
    smallest = std::min(smallest, TrafficLog::height(i));
  }
  std::int64_t before = 0;
  for (std::size_t i = 0; i < series["values"].size(); ++i) {
    shown_largest = std::max(shown_largest, series["values"][i].get<double>());
    shown_smallest = std::min(shown_smallest, series["values"][i].get<double>());
    EXPECT_GE(series["t_us"][i].get<std::int64_t>(), before);
    before = series["t_us"][i];
  }
  EXPECT_EQ(shown_largest, largest);
  EXPECT_EQ(shown_smallest, smallest);
}

TEST(LogView, ASeriesOfAFieldThatIsMissingSaysSo) {
  const TrafficLog log;
  Page page(log);
  EXPECT_EQ(page.series(0, 10'000'000, 20, "pos[3]")["text"],
            "series: shoal.pose_t on 'ball.pose' has no field 'pos[3]'");
}

TEST(LogSeries, WhatCannotBeReadInTimeIsAnError) {
  const TrafficLog log;
  const tools::LogIndex index(log.path);
  bridges::EventLogReader reader(log.path);
  const tools::SeriesRequest request{"1", "ball.pose", "pos[2]", 0, 10'000'000, 100};
  try {
    tools::read_series(reader, index, request, std::chrono::steady_clock::time_point());
    FAIL();
  } catch (const tools::PageRequestError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be read within a second; ask for a shorter range"));
  }
}

}  // namespace
