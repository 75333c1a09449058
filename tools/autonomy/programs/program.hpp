// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shoal/client.hpp"
#include "tools/autonomy/missions/memory.hpp"
#include "tools/command_line/declared_options.hpp"

namespace autonomy {

enum ExitCode { exit_ok = 0, exit_usage = 2, exit_bus = 4, exit_timeout = 5, exit_rewound = 6 };

/// Ends the help of a program: its examples, what it reads and publishes, and the exit codes that all have.
void set_help_end(command_line::DeclaredOptions& options, const std::vector<std::string>& examples,
                  const std::string& channels);

/// Declares the number of a vehicle in acoustic frames, with its present value as default.
command_line::DeclaredOptions::Added add_id(command_line::DeclaredOptions& options, const char* key, int& id,
                                            const std::string& meaning);

/// Declares `name`, which is required.
command_line::DeclaredOptions::Added add_name(command_line::DeclaredOptions& options, std::string& name,
                                              const std::string& meaning);

/// How a program takes part in a run.
struct Participation {
  std::string lcm_url;
  double period_s = 0.1;
  double join_timeout_s = 30;
  double rewind_s = 60;  ///< of simulated time: how far back the program goes with the world; 0: not at all

  void declare(command_line::DeclaredOptions& options);
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

/// Runs a program: std::invalid_argument is wrong usage, any other exception a bus error.
int run_program(const char* name, const std::function<int()>& program);

}  // namespace autonomy
