#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "shoal/client.hpp"
#include "tools/autonomy/memory.hpp"

namespace autonomy {

enum ExitCode { exit_ok = 0, exit_usage = 2, exit_bus = 4, exit_timeout = 5, exit_rewound = 6 };

/// What all programs say of their exit codes in --help.
inline constexpr const char* exit_code_help =
    "Exit codes: 0 the run ended, 2 usage, 4 bus trouble, 5 the simulator fell silent or dropped it, 6 the world "
    "went further back than\n--rewind-s, 130 SIGINT, 143 SIGTERM.";

/// A number of a closed range.  CLI::Range would let NaN through.
CLI::Validator between(double low, double high);

/// How a program takes part in a run.
struct Participation {
  std::string lcm_url;
  double period_s = 0.1;
  double join_timeout_s = 30;
  double rewind_s = 60;  ///< of simulated time: how far back the program goes with the world; 0: not at all

  void add_options(CLI::App& app);
};

/// Joins the run and calls `decide` at each tick, until the run ends or a signal comes.  When the world goes back,
/// `memory` puts the program's state back.  Gives the exit code.
int take_part(shoal::Client& client, const Participation& participation, Memory memory,
              const std::function<void(std::int64_t utime)>& decide);

/// The same for a program all of whose state is `state`.
template <class State>
int take_part(shoal::Client& client, const Participation& participation, State& state,
              const std::function<void(std::int64_t utime)>& decide) {
  return take_part(client, participation, Memory(state, participation.rewind_s), decide);
}

/// Runs a program: what std::invalid_argument says is wrong usage, any other exception is bus trouble.
int run_program(const char* name, const std::function<int()>& program);

/// Parses the command line.  Nothing: go on; else the exit code.
std::optional<int> parse(CLI::App& app, int argc, char** argv);

}  // namespace autonomy
