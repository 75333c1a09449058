// SPDX-License-Identifier: BSD-3-Clause
// How long a message takes between two processes over LCM: LcmListener ("bare LCM") at both ends, and LcmBus at one
// end.
//   latency_bench [MESSAGES]
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "tests/own_ports.hpp"

namespace {

using namespace std::chrono_literals;

std::int64_t now_ns() {
  // The same clock in all processes of a machine.
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

/// Answers every "ping" with a "pong" that holds the ping's time and its own.
void echo(const std::string& on) {
  bridges::LcmListener lcm(on);
  lcm.listen("ping");
  lcm.listen("quit");
  lcm.publish("ready", sim::Bytes(1));
  while (true) {
    auto message = lcm.next(100ms);
    if (!message) {
      lcm.publish("ready", sim::Bytes(1));
      continue;
    }
    if (message->channel == "quit") return;
    const std::int64_t time = now_ns();
    std::memcpy(message->payload.data() + 8, &time, sizeof(time));
    lcm.publish("pong", message->payload);
  }
}

struct Pinger {
  std::function<void(const char* channel, const sim::Bytes&)> publish;
  std::function<std::optional<sim::Bytes>(const char* channel)> await;
};

Pinger bare(bridges::LcmListener& lcm) {
  lcm.listen("pong");
  lcm.listen("ready");
  return {[&](const char* channel, const sim::Bytes& payload) { lcm.publish(channel, payload); },
          [&](const char* channel) -> std::optional<sim::Bytes> {
            while (auto message = lcm.next(2s))
              if (message->channel == channel) return message->payload;
            return std::nullopt;
          }};
}

void report(const char* name, std::vector<std::int64_t> times_ns) {
  if (times_ns.empty()) return;
  std::sort(times_ns.begin(), times_ns.end());
  const auto at = [&](double q) {
    return static_cast<double>(times_ns[static_cast<std::size_t>(q * static_cast<double>(times_ns.size() - 1))]) * 1e-3;
  };
  std::printf("  %-12s p50 %7.1f us   p99 %7.1f us\n", name, at(0.5), at(0.99));
}

void measure(const std::string& name, std::size_t bytes, int messages, const Pinger& pinger) {
  if (!pinger.await("ready")) {
    std::fprintf(stderr, "the other process did not come up\n");
    std::exit(1);
  }
  std::vector<std::int64_t> there, round;
  sim::Bytes payload(bytes);
  int lost = 0;
  for (int i = 0; i < messages; ++i) {
    const std::int64_t sent = now_ns();
    std::memcpy(payload.data(), &sent, sizeof(sent));
    pinger.publish("ping", payload);
    const auto answer = pinger.await("pong");
    const std::int64_t back = now_ns();
    if (!answer) {
      ++lost;
      continue;
    }
    std::int64_t arrived = 0;
    std::memcpy(&arrived, answer->data() + 8, sizeof(arrived));
    there.push_back(arrived - sent);
    round.push_back(back - sent);
  }
  std::printf("%s, %zu B, %d messages, %d lost\n", name.c_str(), bytes, messages, lost);
  report("one way", there);
  report("round trip", round);
  pinger.publish("quit", sim::Bytes(1));
}

}  // namespace

int main(int argc, char** argv) {
  const int messages = argc > 1 ? std::atoi(argv[1]) : 5000;
  const std::string on = test_support::own_url();
  for (const std::size_t bytes : {std::size_t{64}, std::size_t{800}}) {
    for (const bool with_bus : {false, true}) {
      const pid_t child = fork();  // before there is any thread
      if (child == 0) {
        echo(on);
        _exit(0);
      }
      if (with_bus) {
        bridges::LcmBus bus(on);
        const auto pong = bus.open_mailbox("pong");
        const auto ready = bus.open_mailbox("ready");
        measure("LcmBus", bytes, messages,
                {[&](const char* channel, const sim::Bytes& payload) {
                   bus.publish(channel, payload, sim::Time(0));
                   bus.end_of_step();
                 },
                 [&](const char* channel) -> std::optional<sim::Bytes> {
                   const auto deadline = std::chrono::steady_clock::now() + 2s;
                   sim::Mailbox& mailbox = std::strcmp(channel, "pong") == 0 ? *pong : *ready;
                   do {
                     if (auto message = mailbox.take()) return message->payload;
                     bus.wait_for_message(100ms);
                   } while (std::chrono::steady_clock::now() < deadline);
                   return std::nullopt;
                 }});
        bus.flush(1s);
      } else {
        bridges::LcmListener lcm(on);
        measure("bare LCM", bytes, messages, bare(lcm));
      }
      waitpid(child, nullptr, 0);
    }
  }
}
