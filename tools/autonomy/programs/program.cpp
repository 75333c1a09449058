// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/programs/program.hpp"

#include <cmath>
#include <csignal>
#include <iostream>

#include "tools/command_line/checks.hpp"
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

/// SIGTERM and SIGINT stop the client as long as this lives.
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

void set_help_end(CLI::App& app, const std::vector<std::string>& examples, const std::string& channels) {
  command_line::set_help_end(app, {examples,
                                   {{0, "the run ended"},
                                    {2, "wrong usage"},
                                    {4, "bus trouble"},
                                    {5, "the simulator fell silent or dropped the program"},
                                    {6, "the world went further back than --rewind-s"},
                                    {130, "ended by SIGINT; 143 by SIGTERM"}},
                                   {channels}});
}

void Participation::add_options(CLI::App& app) {
  add_number(app, "--period", period_s, "S", 0.001, 10, "simulated seconds between decisions");
  add_number(app, "--rewind-s", rewind_s, "S", 0, 1e6,
             "how far the program can go back with the world, in simulated seconds; 0: not at all");
  add_number(app, "--join-timeout", join_timeout_s, "S", 0.1, 3600, "seconds to wait for the simulator");
  app.add_option("--lcm-url", lcm_url, "instead of LCM_DEFAULT_URL and the default")->type_name("URL");
}

void add_number(CLI::App& app, const char* option, double& value, const char* unit, double low, double high,
                const std::string& meaning) {
  app.add_option(option, value, meaning)
      ->type_name(unit)
      ->capture_default_str()
      ->check(command_line::number_from(low, high));
}

CLI::Option* add_id(CLI::App& app, const char* option, int& id, const std::string& meaning) {
  return app.add_option(option, id, meaning)->type_name("N")->check(command_line::whole_from(0, 255));
}

CLI::Option* add_name(CLI::App& app, std::string& name, const std::string& meaning) {
  return app.add_option("--name", name, meaning + "; also the name in the lockstep")
      ->type_name("NAME")
      ->check(command_line::not_empty());
}

int take_part(shoal::Client& client, const Participation& participation, Memory memory,
              const std::function<void(std::int64_t utime)>& decide) {
  const StopBySignal stop(client);
  bool lost = false;
  client.on_rewind([&](std::int64_t utime) {
    if (memory.go_back(utime)) return;
    lost = true;
    client.stop();
  });
  client.join(participation.period_s, std::chrono::milliseconds(std::llround(1000 * participation.join_timeout_s)));
  while (const auto utime = client.next_tick()) {
    if (lost) break;
    decide(*utime);
    memory.keep(*utime);
  }
  if (lost) {
    std::cerr << "the world went back further than this program can, " << participation.rewind_s
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
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return signal_caught != 0 ? 128 + signal_caught : exit_bus;
  }
}

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  app.set_help_flag("-h,--help", "print this help");
  return command_line::parse(app, argc, argv);
}

}  // namespace autonomy
