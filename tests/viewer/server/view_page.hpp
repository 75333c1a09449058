// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

#include "tests/bridges/web/web_client.hpp"

namespace test {

/// State frame of the page protocol.
struct ViewState {
  std::uint8_t flags;
  std::int64_t time_us;
  std::int32_t branch;
  std::uint32_t count;
  float z_m;  ///< of the first body
  explicit ViewState(const std::string& frame) {
    flags = static_cast<std::uint8_t>(frame[1]);
    std::memcpy(&time_us, frame.data() + 8, 8);
    std::memcpy(&branch, frame.data() + 16, 4);
    std::memcpy(&count, frame.data() + 24, 4);
    std::memcpy(&z_m, frame.data() + 32 + 8, 4);
  }
  bool jump() const { return (flags & 2) != 0; }
  bool past() const { return (flags & 4) != 0; }
};

/// Message frame of the page protocol.
struct ViewMessage {
  std::int64_t time_us = 0;
  web_test::Json header;
  explicit ViewMessage(const std::string& frame) {
    std::uint32_t size = 0;
    std::memcpy(&size, frame.data() + 4, 4);
    std::memcpy(&time_us, frame.data() + 8, 8);
    header = web_test::Json::parse(frame.substr(32, size));
  }
};

/// A page that has the token of a server.
class ViewPage {
 public:
  explicit ViewPage(const std::string& url)
      : client_(static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)))) {
    client_.upgrade();
    send({{"op", "hello"}, {"token", url.substr(url.find("#t=") + 3)}});
  }
  void send(const web_test::Json& message) { client_.send_json(message); }
  void control(const std::string& command, double value = 0, const std::string& text = "") {
    send({{"op", "control"}, {"id", ++id_}, {"command", command}, {"value", value}, {"text", text}});
  }
  /// Reads up to the reply to the last request.
  web_test::Json reply() {
    for (;;)
      if (auto json = text("reply"); json["id"] == id_) return json;
  }
  /// Reads up to the next text of a kind; acknowledges the states before it.
  web_test::Json text(const std::string& op) {
    while (const auto frame = this->frame()) {
      if (frame->is_text() && frame->json()["op"] == op) return frame->json();
      if (!frame->is_text()) acknowledge(frame->payload);
    }
    throw std::runtime_error("no '" + op + "'");
  }
  /// Reads up to the next text of a kind that fulfils a condition.
  template <typename Condition>
  web_test::Json text(const std::string& op, const Condition& condition) {
    for (;;)
      if (auto json = text(op); condition(json)) return json;
  }
  /// Reads up to the next state.
  ViewState state() {
    while (const auto frame = this->frame()) {
      if (frame->is_text() || frame->payload[0] != 1) continue;
      acknowledge(frame->payload);
      return ViewState(frame->payload);
    }
    throw std::runtime_error("no state");
  }
  void subscribe(const std::string& channel) {
    send({{"op", "subscribe"}, {"channels", {{{"name", channel}, {"rate_hz", 30}}}}});
  }
  /// Reads up to the next message of a channel that fulfils a condition.
  template <typename Condition>
  ViewMessage message(const Condition& condition) {
    while (const auto frame = this->frame()) {
      if (frame->is_text()) continue;
      acknowledge(frame->payload);
      if (frame->payload[0] != 2) continue;
      if (const ViewMessage message(frame->payload); condition(message)) return message;
    }
    throw std::runtime_error("no message");
  }
  /// Asks for a time, and reads up to the answer.
  ViewState look(double time_us, int branch = -1) {
    web_test::Json request{{"op", "look"}, {"time_us", time_us}};
    if (branch >= 0) request["branch"] = branch;
    send(request);
    for (;;)
      if (const ViewState answer = state(); answer.past()) return answer;
  }

 private:
  /// Reads the next frame; nothing at the end of the connection.  The status comes again and again, so a wait ends
  /// after a minute.
  std::optional<web_test::Frame> frame() {
    if (std::chrono::steady_clock::now() > deadline_) throw std::runtime_error("what the test waits for has not come");
    return client_.read_frame();
  }
  void acknowledge(const std::string& frame) {
    if (frame[0] != 1 || ViewState(frame).past()) return;
    std::uint32_t sequence = 0;
    std::memcpy(&sequence, frame.data() + 4, 4);
    send({{"op", "ack"}, {"sequence", sequence}});
  }

  web_test::Client client_;
  const std::chrono::steady_clock::time_point deadline_ = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  int id_ = 0;
};

}  // namespace test
