// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <thread>

#include "bridges/view/view_publisher.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/sim_sound_arrival_t.hpp"
#include "shoal/sim_sound_t.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/server/view_page.hpp"
#include "viewer/server/log_view.hpp"

namespace test {

/// A world with a ball at 100 m.
inline std::string falling_ball() {
  return "shoal: 1\nname: fall\nphysics: {step_s: 0.01}\nobjects: [{name: ball, position_m: [1, 2, 100], parts: "
         "[{shape: "
         "sphere, mass_kg: 1}]}]";
}

/// A log of a ball that falls for three seconds, from 100 m, with an event after one.  `estimate_x_m`: it believes to
/// be there, ten times per second, in a shoal.pose_t.
struct FallLog {
  explicit FallLog(const std::string& more = "", const std::optional<double>& estimate_x_m = {}) {
    test::RecordedRun run(falling_ball() + "\nevents: [{name: half, at: 1, do: [{log: one second}]}" + more + "]\n",
                          path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 1; i <= 300; ++i) {
      run.world.step();
      if (estimate_x_m && i % 10 == 0) publish(run, *estimate_x_m);
      view.after_step();
    }
  }
  static void publish(test::RecordedRun& run, double x_m) {
    const sim::Time now = run.world.now();
    run.recorder.set_time(now);
    shoal::pose_t pose{};
    pose.utime = run.world.epoch_us() + now.count();
    pose.pos[0] = x_m;
    pose.orientation[0] = 1;
    run.gate.publish("ball.estimate", shoal::encode(pose), now);
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

/// The same log, with a pose of the ball on `ball.pose` each step, its height in `pos[2]`, and sounds from a to b: the
/// k-th in the step 100 k, of which every second one is lost.
struct TrafficLog {
  TrafficLog() {
    test::RecordedRun run(falling_ball() + "\n", path);
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

/// A page of the log, served in another thread.
struct LogPage {
  template <typename AnyLog>
  explicit LogPage(const AnyLog& log, const std::function<void(viewer::LogView&)>& prepare = {})
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
  ~LogPage() {
    end = true;
    thread.join();
  }
  static experiment::ViewOptions options() {
    experiment::ViewOptions options;
    options.port = 0;
    return options;
  }
  std::uint16_t port() const {
    const std::string url = view.url();
    const std::size_t colon = url.rfind(':');
    return static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1)));
  }
  /// Reads the next frame; nothing at the end of the connection.  The test may take a minute: the status comes
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
  ViewMessage message() {
    while (const auto frame = this->frame())
      if (!frame->is_text() && frame->payload[0] == 2) return ViewMessage(frame->payload);
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
  ViewState next_state() {
    while (const auto frame = client.read_frame()) {
      if (frame->is_text() || frame->payload[0] != 1) continue;
      const ViewState state(frame->payload);
      std::uint32_t sequence = 0;
      std::memcpy(&sequence, frame->payload.data() + 4, 4);
      if (!state.past()) client.send_json({{"op", "ack"}, {"sequence", sequence}});
      return state;
    }
    throw std::runtime_error("no state");
  }
  /// Reads up to the state after a jump to a time, at most 0.1 s before it.
  ViewState state_after_seek(std::int64_t time_us) {
    client.send_json({{"op", "seek"}, {"time_us", time_us}});
    for (;;) {
      const ViewState state = next_state();
      if (state.jump() && state.time_us <= time_us && time_us - state.time_us <= 100'000) return state;
    }
  }

  viewer::LogIndex index;
  viewer::LogView view;
  web_test::Client client;
  const std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  std::atomic<bool> end = false;
  std::thread thread;
};

}  // namespace test
