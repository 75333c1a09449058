// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "experiment/replay/replay.hpp"
#include "experiment/run/runner.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/server/run_view.hpp"

// Runs with clients of rosbridge, at the port of the live page.

namespace {

using web_test::Json;

/// A run of a rover in another thread, paused, with a client.
class RosbridgeRun {
 public:
  explicit RosbridgeRun(bool may_control, const std::string& record = "") {
    loaded_ = sim::load_world_text(test::driven_world(), "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
    options_.bus = "none";
    options_.quiet = options_.paused = true;
    options_.speed = 0;
    options_.duration_s = 4;
    options_.record = record;
    view_.port = 0;
    view_.rosbridge = true;
    view_.rosbridge_control = may_control;
    view_.token = "secretsecretsecret";
    options_.page = viewer::run_page(view_);
    std::promise<std::string> url;
    auto opened = url.get_future();
    view_.opened = [&url](const std::string& text) { url.set_value(text); };
    thread_ = std::thread([this] { summary = experiment::run_world(loaded_, options_); });
    const std::string address = opened.get();
    const std::size_t colon = address.rfind(':');
    port = static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1)));
    client = std::make_unique<web_test::Client>(port);
    EXPECT_EQ(client->upgrade("").status, 101);
  }
  ~RosbridgeRun() { end(); }
  void end() {
    if (!thread_.joinable()) return;
    web_test::Client page(port);
    page.upgrade();
    page.send_json({{"op", "hello"}, {"token", "secretsecretsecret"}});
    page.send_json({{"op", "control"}, {"id", 1}, {"command", "resume"}});
    thread_.join();
  }
  /// Calls a service, and returns its response.
  Json call(const std::string& service, const Json& args = Json::object()) {
    client->send_json({{"op", "call_service"}, {"id", "c"}, {"service", service}, {"args", args}});
    while (const auto frame = client->read_frame())
      if (frame->is_text() && frame->json()["op"] == "service_response") return frame->json();
    throw std::runtime_error("no answer");
  }

  experiment::Summary summary;
  std::uint16_t port = 0;
  std::unique_ptr<web_test::Client> client;

 private:
  sim::LoadedWorld loaded_;
  experiment::RunOptions options_;
  experiment::ViewOptions view_;
  std::thread thread_;
};

TEST(RosbridgeRun, ThatIsDrivenByATwistReplaysEqual) {
  const test_support::ScratchFolder folder;
  RosbridgeRun run(true, folder.file("run.lcm"));
  const Json twist{{"linear", {{"x", 0.5}}}, {"angular", {{"z", 0.1}}}};
  run.client->send_json({{"op", "advertise"}, {"topic", "/r1/cmd_vel"}, {"type", "geometry_msgs/Twist"}});
  run.client->send_json({{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", twist}});
  // In the same order as they were sent
  EXPECT_EQ(run.call("/shoal/step", {{"steps", 100}})["values"]["success"], true);
  run.end();
  EXPECT_EQ(run.summary.exit_code, 0) << run.summary.error;
  experiment::ReplayOptions options;
  options.log = folder.file("run.lcm");
  options.quiet = true;
  const experiment::ReplayOutcome replayed = experiment::replay(options);
  EXPECT_EQ(replayed.exit_code(), 0);
  EXPECT_EQ(replayed.steps, 400);
  // The command is part of it: without it the run is another one.
  RosbridgeRun plain(true);
  plain.end();
  EXPECT_NE(plain.summary.run_hash, run.summary.run_hash);
}

TEST(RosbridgeRun, AClientThatReadsAllChangesNothing) {
  RosbridgeRun run(false);
  const Json topics = run.call("/rosapi/topics")["values"]["topics"];
  for (const Json& topic : topics) run.client->send_json({{"op", "subscribe"}, {"topic", topic}});
  const Json refused = run.call("/shoal/pause");
  EXPECT_EQ(refused["result"], false);
  EXPECT_EQ(refused["values"], "control is off: start Shoal with --rosbridge-control");
  run.end();
  RosbridgeRun plain(true);
  plain.end();
  EXPECT_EQ(plain.summary.run_hash, run.summary.run_hash);
}

}  // namespace
