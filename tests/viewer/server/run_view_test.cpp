// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/run_view.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <thread>

#include "experiment/run/runner.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/own_ports.hpp"

namespace {

using web_test::Json;

sim::LoadedWorld rover() {
  return sim::load_world_text(
      test::rover_world("        - {name: lidar, type: lidar}\n", "", "", "name: small\nrun: {seed: 7}\n"),
      "small.yaml");
}

experiment::RunOptions quiet_run() {
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  options.keys = false;
  options.speed = 1;
  options.duration_s = 2;
  return options;
}

/// What a page without the token got of a run.
struct Seen {
  int messages = 0;
  Json message, channels;
};

/// Opens a page as soon as the server is there, subscribes to a channel, and reads until the run ends.
Seen watch(std::uint16_t port, const std::string& channel) {
  std::optional<web_test::Client> client;
  web_test::await([&] {
    try {
      client.emplace(port);
      return true;
    } catch (const std::runtime_error&) {
      return false;
    }
  });
  Seen seen;
  client->upgrade();
  client->send_json({{"op", "hello"}});
  client->send_json({{"op", "subscribe"}, {"channels", {{{"name", channel}, {"rate_hz", 30}}}}});
  while (const auto frame = client->read_frame()) {
    if (frame->opcode == 8) break;
    if (frame->is_text()) {
      if (frame->json()["op"] == "channels") seen.channels = frame->json();
    } else if (frame->payload[0] == 2) {
      std::uint32_t size = 0;
      std::memcpy(&size, frame->payload.data() + 4, 4);
      seen.message = Json::parse(frame->payload.substr(32, size));
      ++seen.messages;
    } else {
      std::uint32_t sequence = 0;
      std::memcpy(&sequence, frame->payload.data() + 4, 4);
      client->send_json({{"op", "ack"}, {"sequence", sequence}});
    }
  }
  return seen;
}

TEST(RunView, ASubscriptionDoesNotChangeTheRun) {
  const experiment::Summary alone = experiment::run_world(rover(), quiet_run());
  experiment::RunOptions options = quiet_run();
  const experiment::ViewOptions view{.port = static_cast<std::uint16_t>(test_support::own_port()), .port_tries = 1};
  options.page = viewer::run_page(view);
  Seen seen;
  std::thread page([&] { seen = watch(view.port, "r1.lidar"); });
  const auto begin = std::chrono::steady_clock::now();
  const experiment::Summary watched = experiment::run_world(rover(), options);
  page.join();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(seen.messages, 2);
  EXPECT_LE(seen.messages, 30 * took.count() + 5) << "30 per second of wall time";
  EXPECT_EQ(seen.message["channel"], "r1.lidar");
  EXPECT_EQ(seen.message["fields"]["ranges"]["array"], "f32");
  EXPECT_EQ(watched.run_hash, alone.run_hash);
  EXPECT_EQ(watched.state_hash, alone.state_hash);
  // The counts, with the vehicle and the type of each channel
  Json lidar;
  for (const Json& item : seen.channels["items"])
    if (item["name"] == "r1.lidar") lidar = item;
  EXPECT_EQ(lidar["vehicle"], "r1");
  EXPECT_EQ(lidar["type"], "shoal.planar_lidar_t");
  EXPECT_GT(lidar["count"], 0);
}

}  // namespace
