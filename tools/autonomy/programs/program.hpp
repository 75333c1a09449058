// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shoal/client.hpp"
#include "tools/autonomy/missions/memory.hpp"

namespace autonomy {

enum ExitCode { exit_ok = 0, exit_usage = 2, exit_bus = 4, exit_timeout = 5, exit_rewound = 6 };

/// Ends the help of a program: its examples, what it reads and publishes, and the exit codes that all have.
void set_help_end(CLI::App& app, const std::vector<std::string>& examples, const std::string& channels);

/// Adds an option for a number of a closed range, with its present value as default.
void add_number(CLI::App& app, const char* option, double& value, const char* unit, double low, double high,
                const std::string& meaning);

/// Adds an option for the number of a vehicle in acoustic frames, with its present value as default.
CLI::Option* add_id(CLI::App& app, const char* option, int& id, const std::string& meaning);

/// Adds the required `--name`.
CLI::Option* add_name(CLI::App& app, std::string& name, const std::string& meaning);

/// Reads the text of an option: an std::invalid_argument names the option, too.
template <class Read>
auto read_option(const char* option, const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(option) + ": " + error.what());
  }
}

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
