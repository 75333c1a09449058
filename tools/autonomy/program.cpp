#include "tools/autonomy/program.hpp"

#include <cmath>
#include <csignal>
#include <iostream>
#include <sstream>

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

CLI::Validator between(double low, double high) {
  std::ostringstream range;
  range << '[' << low << " - " << high << ']';
  const auto check = [low, high, text = range.str()](std::string& input) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(input, value) && value >= low && value <= high) return {};
    return "value " + input + " not in range " + text;
  };
  return CLI::Validator(check, "FLOAT in " + range.str());
}

void Participation::add_options(CLI::App& app) {
  app.add_option("--period", period_s, "s of simulated time between decisions")
      ->capture_default_str()
      ->check(between(0.001, 10.0));
  app.add_option("--rewind-s", rewind_s, "s of simulated time: how far it can go back with the world; 0: not at all")
      ->capture_default_str()
      ->check(between(0.0, 1e6));
  app.add_option("--join-timeout", join_timeout_s, "s to wait for the simulator")
      ->capture_default_str()
      ->check(between(0.1, 3600.0));
  app.add_option("--lcm-url", lcm_url, "unset: LCM_DEFAULT_URL, then LCM's default");
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
    std::cerr << name << ": " << error.what() << '\n';
    return exit_usage;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return signal_caught != 0 ? 128 + signal_caught : exit_bus;
  }
}

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    // CLI11 has exit codes of its own; all that is not help is wrong usage.
    return app.exit(error) == 0 ? exit_ok : exit_usage;
  }
}

}  // namespace autonomy
