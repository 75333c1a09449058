// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/log/event_log.hpp"
#include "bridges/log/recording_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace scripted_bus {

using namespace bridges;
using namespace std::chrono_literals;

inline constexpr std::int64_t epoch = 1'700'000'000'000'000;

inline std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Hands every mailbox what the test put in, and keeps no message that was published.
class ScriptedBus final : public sim::Bus {
 public:
  std::queue<sim::Message> incoming;
  int published = 0;

  void publish(std::string_view, std::span<const std::byte>, sim::Time) override { ++published; }
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string&, std::size_t) override {
    return std::make_unique<Box>(incoming);
  }
  sim::BusCounts counts() const override { return {}; }

 private:
  struct Box final : sim::Mailbox {
    explicit Box(const std::queue<sim::Message>& scripted) : messages(scripted) {}
    std::optional<sim::Message> take() override {
      if (messages.empty()) return std::nullopt;
      sim::Message message = messages.front();
      messages.pop();
      return message;
    }
    std::uint64_t dropped() const override { return 0; }
    void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) override {
      if (!messages.empty()) flag->store(true);
    }
    std::queue<sim::Message> messages;
  };
};

inline void run(sim::Bus& inner, const std::string& path) {
  RecordingBus bus(inner, path, epoch);
  for (int i = 0; i < 1000; ++i) {
    bus.publish("a.b", lcm_test::bytes_of(std::string(static_cast<std::size_t>(i % 50), 'x')), sim::Time(i * 10'000));
    bus.end_of_step();
  }
  EXPECT_EQ(bus.recorded(), 1000u);
  EXPECT_EQ(bus.error().value_or(""), "");
}

inline std::vector<LogEvent> read_all(EventLogReader& reader) {
  std::vector<LogEvent> events;
  while (auto event = reader.next()) events.push_back(std::move(*event));
  return events;
}

}  // namespace scripted_bus
