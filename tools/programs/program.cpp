// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/program.hpp"

#include <cmath>
#include <csignal>
#include <iostream>

#include "sim/config/diagnostics.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"

namespace autonomy {

namespace {

shoal::Client* client_to_stop = nullptr;
volatile std::sig_atomic_t signal_caught = 0;

void on_signal(int signal) {
  signal_caught = signal;
  if (client_to_stop != nullptr) client_to_stop->stop();
}

/// SIGTERM and SIGINT stop the client during the lifetime of this object.
class StopBySignal {
 public:
  explicit StopBySignal(shoal::Client& client) {
    client_to_stop = &client;
    std::signal(SIGTERM, on_signal);
    std::signal(SIGINT, on_signal);
  }
  ~StopBySignal() {
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    client_to_stop = nullptr;
  }
  StopBySignal(const StopBySignal&) = delete;
  StopBySignal& operator=(const StopBySignal&) = delete;
};

}  // namespace

void set_help_end(command_line::DeclaredOptions& options, const std::vector<std::string>& examples,
                  const std::string& channels) {
  command_line::set_help_end(options.app(), {examples,
                                             {{0, "the run ended"},
                                              {2, "wrong usage"},
                                              {4, "bus error"},
                                              {5, "the simulator stopped responding or dropped the program"},
                                              {6, "the world was rewound further than --rewind-s"},
                                              {130, "ended by SIGINT; 143 by SIGTERM"}},
                                             {channels}});
}

void Participation::declare(command_line::DeclaredOptions& options) {
  options.number("period_s", period_s, 0.001, 10, "simulated seconds between decisions");
  options.number("rewind_s", rewind_s, 0, 1e6,
                 "how far the program can be rewound with the world, in simulated seconds; 0: not at all");
  options.number("join_timeout_s", join_timeout_s, 0.1, 3600, "wall seconds to wait for the simulator");
  options.text("lcm_url", "URL", lcm_url, "LCM URL; overrides LCM_DEFAULT_URL");
}

command_line::DeclaredOptions::Added add_id(command_line::DeclaredOptions& options, const char* key, int& id,
                                            const std::string& meaning) {
  return options.integer(key, id, 0, 255, meaning);
}

command_line::DeclaredOptions::Added add_name(command_line::DeclaredOptions& options, std::string& name,
                                              const std::string& meaning) {
  return options.text("name", "NAME", name, meaning + "; also the name in the lockstep");
}

int take_part(shoal::Client& client, const Participation& participation, Memory memory,
              const std::function<void(std::int64_t utime)>& decide) {
  const StopBySignal stop(client);
  bool lost = false;
  // A program whose memory does not reach back would continue with knowledge of a future that never came.
  client.on_rewind([&](std::int64_t utime) {
    if (memory.rewind(utime)) return;
    lost = true;
    client.stop();
  });
  if (participation.in_lockstep)
    client.join(participation.period_s, std::chrono::milliseconds(std::llround(1000 * participation.join_timeout_s)));
  else
    client.follow(participation.period_s);
  while (const auto utime = client.next_tick()) {
    if (lost) break;
    decide(*utime);
    memory.keep(*utime);
  }
  if (lost) {
    std::cerr << "the world was rewound further than this program supports, " << participation.rewind_s
              << " s (--rewind-s); it ends\n";
    return exit_rewound;
  }
  if (signal_caught != 0) return 128 + signal_caught;
  switch (client.end()) {
    case shoal::Client::End::silence:
      return exit_timeout;
    case shoal::Client::End::dropped:
      std::cerr << client.reason() << '\n';
      return exit_timeout;
    default:
      return exit_ok;
  }
}

int run_program(const char* name, const std::function<int()>& program) {
  try {
    return program();
  } catch (const std::invalid_argument& error) {
    return command_line::wrong_usage(name, error.what());
  } catch (const sim::ConfigError& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return exit_usage;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return signal_caught != 0 ? 128 + signal_caught : exit_bus;
  }
}

}  // namespace autonomy
