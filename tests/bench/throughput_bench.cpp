// SPDX-License-Identifier: BSD-3-Clause
// How much of what one process sends flat out another one receives, by LcmBus and by LcmListener.
//   throughput_bench [SECONDS]
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "tests/own_ports.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Sends for `seconds`; then says how many it were, until it is killed.
[[noreturn]] void send_flat_out(const std::string& on, std::size_t bytes, double seconds) {
  bridges::LcmListener lcm(on);
  const sim::Bytes payload(bytes);
  sim::Bytes count(8);
  std::uint64_t sent = 0;
  for (const auto begin = Clock::now(); Clock::now() - begin < std::chrono::duration<double>(seconds); ++sent)
    lcm.publish("data", payload);
  std::memcpy(count.data(), &sent, sizeof sent);
  while (true) {
    usleep(50'000);
    lcm.publish("sent", count);
  }
}

template <class Next>
void measure(const char* name, std::size_t bytes, double seconds, const std::string& on, const Next& next) {
  const pid_t child = fork();  // it uses nothing of this process's threads
  if (child == 0) send_flat_out(on, bytes, seconds);
  std::uint64_t received = 0, sent = 0;
  while (sent == 0) next(received, sent);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  std::printf("%-12s %7zu B: %8.0f messages/s, %7.1f MB/s received, %5.2f %% lost\n", name, bytes,
              static_cast<double>(received) / seconds, static_cast<double>(received * bytes) * 1e-6 / seconds,
              100 - 100 * static_cast<double>(received) / static_cast<double>(sent));
}

std::uint64_t number_in(const sim::Bytes& payload) {
  std::uint64_t number = 0;
  std::memcpy(&number, payload.data(), sizeof number);
  return number;
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 2;
  const std::string on = test_support::own_url();
  for (const std::size_t bytes : {64u, 800u, 65'000u, 300'000u}) {
    {
      bridges::LcmBus bus(on);
      const auto data = bus.open_mailbox("data", 1'000'000), end = bus.open_mailbox("sent");
      measure("LcmBus", bytes, seconds, on, [&](std::uint64_t& received, std::uint64_t& sent) {
        bus.wait_for_message(20ms);
        while (data->take()) ++received;
        if (const auto message = end->take()) sent = number_in(message->payload);
      });
    }
    bridges::LcmListener listener(on);
    listener.listen("data");
    listener.listen("sent");
    measure("LcmListener", bytes, seconds, on, [&](std::uint64_t& received, std::uint64_t& sent) {
      const auto message = listener.next(20ms);
      if (message && message->channel == "data") ++received;
      if (message && message->channel == "sent") sent = number_in(message->payload);
    });
  }
}
