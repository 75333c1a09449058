// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <future>
#include <mutex>
#include <thread>

#include "experiment/replay/replay.hpp"
#include "experiment/run/runner.hpp"
#include "messages/yaml/message_writer.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/server/run_view.hpp"

// Runs that are steered by a Foxglove client, and watched by one that does not read.

namespace {

using testing::HasSubstr;
using web_test::Json;

/// Client of the protocol of Foxglove.
class FoxgloveClient {
 public:
  explicit FoxgloveClient(std::uint16_t port, int receive_bytes = 0) : client_(port, false, receive_bytes) {
    client_.upgrade("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n");
  }
  /// Calls a service, and reads up to its answer.
  Json call(std::uint32_t service, const Json& request) {
    std::string frame(1, '\2');
    add(frame, service);
    add(frame, ++call_);
    add(frame, 4);
    client_.send_frame(2, frame + "json" + request.dump());
    while (const auto answer = client_.read_frame()) {
      if (answer->is_text() && answer->json()["op"] == "serviceCallFailure")
        throw std::runtime_error(answer->json()["message"].get<std::string>());
      constexpr std::size_t head_bytes = 1 + 3 * 4 + 4;
      if (!answer->is_text() && answer->payload[0] == '\3') return Json::parse(answer->payload.substr(head_bytes));
    }
    throw std::runtime_error("no answer");
  }
  /// Reads up to the next text of a kind.
  Json text(const std::string& op) {
    while (const auto frame = client_.read_frame())
      if (frame->is_text() && frame->json()["op"] == op) return frame->json();
    throw std::runtime_error("no '" + op + "'");
  }
  /// Subscribes to the topics of every `advertise` up to the one with a topic; they come in parts.
  void subscribe_up_to(const std::string& last) {
    for (bool found = false; !found;) {
      const Json advertised = text("advertise");
      Json subscriptions = Json::array();
      for (const Json& channel : advertised["channels"]) {
        subscriptions.push_back({{"id", channel["id"]}, {"channelId", channel["id"]}});
        found = found || channel["topic"] == last;
      }
      client_.send_json({{"op", "subscribe"}, {"subscriptions", subscriptions}});
    }
  }

 private:
  static void add(std::string& frame, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) frame += static_cast<char>(value >> (8 * i) & 255);
  }

  web_test::Client client_;
  std::uint32_t call_ = 0;
};

constexpr std::uint32_t pause_service = 1, resume_service = 2, step_service = 3, spawn_service = 6, do_service = 7;

/// A run of a rover in another thread, paused, that Foxglove may control.
class FoxgloveRun {
 public:
  explicit FoxgloveRun(double duration_s, const std::string& record = "") {
    loaded_ = sim::load_world_text(test::driven_world(), "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
    options_.bus = "none";
    options_.quiet = options_.paused = true;
    options_.speed = 0;
    options_.duration_s = duration_s;
    options_.record = record;
    view_.port = 0;
    view_.foxglove_control = true;
    options_.page = viewer::run_page(view_);
    std::promise<std::string> url;
    auto opened = url.get_future();
    view_.opened = [&url](const std::string& text) { url.set_value(text); };
    thread_ = std::thread([this] { summary = experiment::run_world(loaded_, options_); });
    const std::string address = opened.get();
    port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    client = std::make_unique<FoxgloveClient>(port);
  }
  ~FoxgloveRun() { end(); }
  void end() {
    if (!thread_.joinable()) return;
    client->call(resume_service, Json::object());
    thread_.join();
  }

  experiment::Summary summary;
  std::uint16_t port = 0;
  std::unique_ptr<FoxgloveClient> client;

 private:
  sim::LoadedWorld loaded_;
  experiment::RunOptions options_;
  experiment::ViewOptions view_;
  std::thread thread_;
};

/// Counts the warnings of dropped messages, which come from the thread of the server.
class DropWarnings final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  std::atomic<int> count = 0;

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string_view text(message.payload.data(), message.payload.size());
    if (text.find("a Foxglove client reads more slowly") != std::string_view::npos) ++count;
  }
  void flush_() override {}
};

TEST(FoxgloveRun, ThatWasPausedSteppedFaultedAndAddedToReplaysEqual) {
  const test_support::ScratchFolder folder;
  FoxgloveRun run(4, folder.file("run.lcm"));
  const auto succeeds = [&](std::uint32_t service, const Json& request) {
    const Json answer = run.client->call(service, request);
    EXPECT_EQ(answer["success"], true) << answer;
  };
  succeeds(step_service, {{"steps", 100}});
  succeeds(do_service, {{"action", "{fault: {device: r1/lidar, kind: stuck}}"}});
  succeeds(spawn_service, {{"request", "{name: r2, file: rover.yaml, position_m: [-3, 0, 0]}"}});
  succeeds(step_service, {{"steps", 50}});
  succeeds(pause_service, Json::object());
  run.end();
  EXPECT_EQ(run.summary.exit_code, 0) << run.summary.error;
  experiment::ReplayOptions options;
  options.log = folder.file("run.lcm");
  options.quiet = true;
  const experiment::ReplayOutcome replayed = experiment::replay(options);
  EXPECT_EQ(replayed.exit_code(), 0);
  EXPECT_EQ(replayed.steps, 400);
  EXPECT_GT(replayed.hashes, 0u);
  // The requests are part of it: without them the run is another one.
  FoxgloveRun plain(4);
  plain.end();
  EXPECT_NE(plain.summary.run_hash, run.summary.run_hash);
}

TEST(FoxgloveRun, AClientThatDoesNotReadLosesMessagesWithOneWarningAndChangesNothing) {
  const auto warnings = std::make_shared<DropWarnings>();
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", warnings));
  std::uint64_t watched = 0;
  {
    FoxgloveRun run(300);
    run.client->call(step_service, {{"steps", 100}});  // every device has sent, so that its topic is known
    FoxgloveClient frozen(run.port, 4096);
    frozen.subscribe_up_to("/r1/lidar");
    run.client->call(step_service, {{"steps", 28'900}});
    ASSERT_TRUE(web_test::await([&] { return warnings->count > 0; }));
    const Json status = frozen.text("status");
    EXPECT_EQ(status["level"], 1);
    EXPECT_THAT(status["message"].get<std::string>(), HasSubstr("messages were dropped"));
    run.end();
    watched = run.summary.run_hash;
  }
  spdlog::set_default_logger(before);
  EXPECT_EQ(warnings->count, 1);
  FoxgloveRun plain(300);
  plain.end();
  EXPECT_EQ(plain.summary.run_hash, watched);
}

}  // namespace
