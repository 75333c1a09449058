// SPDX-License-Identifier: BSD-3-Clause
// A lockstep client for tests: what it does depends on every byte that it receives, and on nothing else.  At the end
// it prints a hash of all that it handled, in order.
//   lockstep_pilot --name pilot --vehicle rover1 --receive rover1.odometry ...
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cstdio>
#include <iostream>
#include <random>
#include <thread>

#include "shoal/client.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/twist_command_t.hpp"

namespace {

struct Pilot {
  std::string name = "pilot", vehicle, lcm_url;
  std::vector<std::string> receive;
  double period_s = 0.1;
  shoal::Client::JoinOptions join;
  double slow_ms = 0;          ///< of wall time, at random up to this before each answer
  unsigned seed = 1;           ///< of that
  std::int64_t stop_at = -1;   ///< tick at which it stands still; `join` applies only from then on
  std::int64_t die_at = -1;    ///< tick at which it kills itself
  std::int64_t quit_at = -1;   ///< tick at which it ends with exit code 0, and does not leave
  std::int64_t leave_at = -1;  ///< tick after which it leaves
  std::string reason;          ///< why it leaves; it then waits until it is ended
  bool rewinds = false;        ///< with the world
};

std::uint64_t mixed(std::uint64_t hash, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3;  // FNV-1a
  return hash;
}

int fly(const Pilot& pilot) {
  shoal::Client client(pilot.name, pilot.lcm_url);
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::string& channel : pilot.receive)
    client.subscribe_bytes(channel, [&hash, channel](std::span<const std::byte> payload) {
      hash = mixed(mixed(hash, channel.data(), channel.size()), payload.data(), payload.size());
    });
  if (pilot.rewinds) client.on_rewind([&hash](std::int64_t) { hash = 0; });
  shoal::Client::JoinOptions patient = pilot.join;
  if (pilot.stop_at > 0) patient.timeout_s = 1000;  // what counts is the silence that is meant
  client.join(pilot.period_s, patient);
  std::cerr << "joined\n";
  std::mt19937 random(pilot.seed);
  std::int64_t ticks = 0;
  while (const auto now = client.next_tick()) {
    if (++ticks == pilot.leave_at) break;
    if (ticks == pilot.die_at) kill(getpid(), SIGKILL);
    if (ticks == pilot.quit_at) _exit(0);
    if (ticks == pilot.stop_at) {
      client.join(pilot.period_s, pilot.join);
      raise(SIGSTOP);
    }
    if (pilot.slow_ms > 0)
      std::this_thread::sleep_for(
          std::chrono::duration<double, std::milli>(std::uniform_real_distribution<>(0, pilot.slow_ms)(random)));
    if (!pilot.vehicle.empty()) {
      shoal::twist_command_t command{};
      command.utime = *now;
      command.forward_mps = 0.1 + static_cast<double>(hash % 1000) * 1e-3;
      command.turn_radps = static_cast<double>(hash / 1000 % 1000) * 1e-3 - 0.5;
      client.publish(pilot.vehicle + ".drive.cmd", command);
    }
    shoal::estimate_t note{};
    note.utime = *now;
    note.yaw_rad = static_cast<double>(hash % 6);
    client.publish(pilot.name + ".note", note);
  }
  if (ticks == pilot.leave_at) client.set_reason_to_leave(pilot.reason);
  const auto counts = client.counts();
  std::printf("hash %016" PRIx64 " ticks %" PRId64 " requested %" PRIu64 " repeated %" PRIu64 " end %d\n", hash, ticks,
              counts.requested, counts.repeated, static_cast<int>(client.end()));
  if (!client.reason().empty()) std::printf("%s\n", client.reason().c_str());
  return client.end() == shoal::Client::End::last_tick || ticks == pilot.leave_at ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Pilot pilot;
  CLI::App app;
  app.add_option("--name", pilot.name);
  app.add_option("--vehicle", pilot.vehicle);
  app.add_option("--receive", pilot.receive);
  app.add_option("--period", pilot.period_s);
  app.add_option("--on-timeout", pilot.join.on_timeout);
  app.add_option("--timeout", pilot.join.timeout_s);
  app.add_option("--slow-ms", pilot.slow_ms);
  app.add_option("--seed", pilot.seed);
  app.add_option("--stop-at", pilot.stop_at);
  app.add_option("--die-at", pilot.die_at);
  app.add_option("--quit-at", pilot.quit_at);
  app.add_option("--leave-at", pilot.leave_at);
  app.add_option("--reason", pilot.reason);
  app.add_flag("--go-back", pilot.rewinds);
  app.add_option("--lcm-url", pilot.lcm_url);
  CLI11_PARSE(app, argc, argv);
  try {
    const int exit_code = fly(pilot);
    if (!pilot.reason.empty()) pause();
    return exit_code;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 4;
  }
}
