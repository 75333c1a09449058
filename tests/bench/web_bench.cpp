// SPDX-License-Identifier: BSD-3-Clause
// Cost of the live page's server: states of 1000 bodies at 30 Hz with an event each, for a few kinds of clients.
//   web_bench [SECONDS]
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include "bridges/web/web_server.hpp"
#include "tests/bridges/web/web_client.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t bodies = 1000, state_bytes = 32 + 20 * bodies;
constexpr auto period = 33'333us;
const std::string token = "0123456789abcdef";
const std::string event = R"({"op":"events","items":[{"time_us":1,"kind":"event","who":"auv1","text":"waypoint"}]})";

double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double web_cpu_s(bridges::WebServer& server) {
  std::promise<double> answer;
  server.run_in_thread([&] { answer.set_value(thread_cpu_s()); });
  return answer.get_future().get();
}

double max_resident_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Page that reads and acknowledges, in its own thread, until the server ends.
class Reader {
 public:
  explicit Reader(bridges::WebServer& server) : client_(server.port()) {
    client_.upgrade();
    client_.send_json({{"op", "hello"}, {"token", token}});
    client_.read_frame();
    thread_ = std::thread([this] { run(); });
  }
  ~Reader() { thread_.join(); }
  int states() const { return states_; }

 private:
  void run() {
    while (const auto frame = client_.read_frame()) {
      if (frame->opcode == 8) return;
      if (frame->is_text()) continue;
      ++states_;
      std::uint32_t sequence = 0;
      for (std::size_t i = 8; i-- > 4;) sequence = sequence << 8 | static_cast<unsigned char>(frame->payload[i]);
      client_.send_json({{"op", "ack"}, {"sequence", sequence}});
    }
  }

  web_test::Client client_;
  std::atomic<int> states_ = 0;
  std::thread thread_;
};

/// Page that says hello and never reads again.
class Frozen {
 public:
  explicit Frozen(bridges::WebServer& server) : client_(server.port(), false, 4096) {
    client_.upgrade();
    client_.send_json({{"op", "hello"}, {"token", token}});
    client_.read_frame();
  }

 private:
  web_test::Client client_;
};

struct Figures {
  double web_share = 0, sender_us = 0;
  int sent = 0;
};

/// Sends at 30 Hz as a simulation does.
Figures run(bridges::WebServer& server, double seconds) {
  std::vector<std::byte> state(state_bytes);
  Figures figures;
  const double web_before = web_cpu_s(server);
  const auto begin = Clock::now();
  double sender_s = 0;
  while (Clock::now() - begin < std::chrono::duration<double>(seconds)) {
    ++figures.sent;
    for (std::size_t i = 0; i < 4; ++i) state[4 + i] = static_cast<std::byte>(figures.sent >> (8 * i));
    const double before = thread_cpu_s();
    if (server.clients() > 0) {
      server.send_state(state);
      server.send_text(event);
    }
    sender_s += thread_cpu_s() - before;
    std::this_thread::sleep_until(begin + figures.sent * period);
  }
  const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  figures.web_share = 100 * (web_cpu_s(server) - web_before) / wall_s;
  figures.sender_us = 1e6 * sender_s / figures.sent;
  return figures;
}

void measure(const char* name, int readers, int frozen, double seconds) {
  bridges::WebOptions options;
  options.port = 0;
  options.token = token;
  std::list<Reader> reading;
  std::list<Frozen> not_reading;
  bridges::WebServer server(options);
  server.retain("hello", R"({"op":"hello","version":1})");
  for (int i = 0; i < readers; ++i) reading.emplace_back(server);
  for (int i = 0; i < frozen; ++i) not_reading.emplace_back(server);
  const Figures figures = run(server, seconds);
  int fewest = readers == 0 ? 0 : figures.sent;
  for (const Reader& reader : reading) fewest = std::min(fewest, reader.states());
  std::printf("%-28s %14.2f %16.2f %10d %10d %12.1f\n", name, figures.web_share, figures.sender_us, figures.sent,
              fewest, max_resident_mb());
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10.0;
  std::printf("%-28s %14s %16s %10s %10s %12s\n", "clients", "web thread/%", "sender/us each", "sent", "received",
              "max RSS/MB");
  measure("none", 0, 0, seconds);
  measure("one", 1, 0, seconds);
  measure("four", 4, 0, seconds);
  measure("one, and one frozen", 1, 1, seconds);
}
