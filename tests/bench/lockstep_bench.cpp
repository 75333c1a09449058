// SPDX-License-Identifier: BSD-3-Clause
// What lockstep costs: the time from a tick to the last answer, for 1 and 10 clients, beside a bare LCM ping-pong of
// the same sizes in the same run; and how fast a small world runs with 10 clients at 100 Hz.
//   lockstep_bench [STEPS [CLIENTS ...]]
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/control/sim_service.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/lockstep_client.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/own_ports.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

struct Times {
  double p50_us = 0, p99_us = 0;
};

Times quantiles(std::vector<double> times_us) {
  std::sort(times_us.begin(), times_us.end());
  const auto at = [&](double q) {
    return times_us[static_cast<std::size_t>(q * (static_cast<double>(times_us.size()) - 1))];
  };
  return {at(0.5), at(0.99)};
}

double us_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

/// LcmListener at both ends, which is LCM without mailboxes: one message there, one back.
Times ping_pong(const std::string& on, int rounds) {
  const pid_t child = fork();
  if (child == 0) {
    bridges::LcmListener lcm(on);
    lcm.listen("ping");
    lcm.publish("ready", sim::Bytes(1));
    while (true) {
      const auto message = lcm.next(100ms);
      if (!message)
        lcm.publish("ready", sim::Bytes(1));
      else if (message->payload.size() == 1)
        _exit(0);
      else
        lcm.publish("pong", message->payload);
    }
  }
  bridges::LcmListener lcm(on);
  lcm.listen("pong");
  lcm.listen("ready");
  const auto await = [&](const char* channel) {
    while (const auto message = lcm.next(2s))
      if (message->channel == channel) return;
  };
  await("ready");
  const sim::Bytes payload(80);
  std::vector<double> times_us;
  for (int i = 0; i < rounds; ++i) {
    const auto begin = Clock::now();
    lcm.publish("ping", payload);
    await("pong");
    times_us.push_back(us_since(begin));
  }
  lcm.publish("ping", sim::Bytes(1));
  waitpid(child, nullptr, 0);
  return quantiles(times_us);
}

void be_a_client(const std::string& on, int number) {
  bridges::LockstepClient client(on, "client" + std::to_string(number));
  client.join(0.01, 30s);
  shoal::sim_tick_t tick{};
  while (client.next_tick(tick)) client.acknowledge(tick);
  _exit(0);
}

struct Cost {
  Times barrier;
  double real_time_factor;
};

Cost lockstep(const std::string& on, int clients, int steps) {
  std::vector<pid_t> children;
  for (int i = 0; i < clients; ++i) {
    const pid_t child = fork();  // before there is any thread
    if (child == 0) be_a_client(on, i);
    children.push_back(child);
  }
  const auto loaded = sim::load_world_text(
      "shoal: 1\nphysics: {step_s: 0.01}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
      "vehicles: [{name: a, model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]}}]\n",
      "bench.yaml", {});
  bridges::LcmBus bus(on);
  sim::MessageGate gate(bus);
  sim::World world(loaded.config, gate);
  sim::RunControl control;
  bridges::LockstepService service_of_clients(world, control, {{bus, gate}});
  bridges::SimService service(gate, bus, world, control, service_of_clients, {"", ""});
  const auto wait = [&](std::chrono::milliseconds time) { bus.wait_for_message(time); };
  for (int i = 0; i < clients; ++i)
    while (!service_of_clients.has("client" + std::to_string(i))) {
      service.handle_requests();
      wait(10ms);
    }
  std::vector<double> times_us;
  const auto begin = Clock::now();
  for (int step = 0; step < steps; ++step) {
    gate.admit();
    world.step();
    service.publish_step();
    gate.end_of_step();
    const auto barrier = Clock::now();
    service_of_clients.synchronize(wait, [&] {
      service.handle_requests();
      return true;
    });
    times_us.push_back(us_since(barrier));
  }
  const double wall_us = us_since(begin);
  service_of_clients.publish_end(wait, 1s);
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  return {quantiles(times_us), 0.01 * steps * 1e6 / wall_us};
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 2000;
  const std::string on = test_support::own_url();
  std::vector<int> numbers;
  for (int i = 2; i < argc; ++i) numbers.push_back(std::atoi(argv[i]));
  if (numbers.empty()) numbers = {1, 10};
  for (const int clients : numbers) {
    const Times bare = ping_pong(on, steps);  // each time: the load of a machine changes
    std::printf("bare LCM ping-pong      p50 %7.1f us   p99 %7.1f us\n", bare.p50_us, bare.p99_us);
    std::fflush(stdout);  // before the children get a copy of what waits there
    const Cost cost = lockstep(on, clients, steps);
    std::printf(
        "barrier, %2d client%s     p50 %7.1f us   p99 %7.1f us   per client p50 %6.1f us   ratio to ping-pong %.2f   "
        "%.0f times real time at 100 Hz\n",
        clients, clients == 1 ? " " : "s", cost.barrier.p50_us, cost.barrier.p99_us, cost.barrier.p50_us / clients,
        cost.barrier.p50_us / clients / bare.p50_us, cost.real_time_factor);
  }
}
