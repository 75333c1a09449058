// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "autonomy/behaviors/memory.hpp"
#include "shoal/client.hpp"
#include "tools/command_line/declared_options.hpp"

namespace autonomy {

enum ExitCode { exit_ok = 0, exit_usage = 2, exit_bus = 4, exit_timeout = 5, exit_rewound = 6 };

/// Appends to the help of a program: its examples, its channels, and the exit codes that all programs share.
void set_help_end(command_line::DeclaredOptions& options, const std::vector<std::string>& examples,
                  const std::string& channels);

/// Declares the number of a vehicle in acoustic frames, with its present value as default.
command_line::DeclaredOptions::Added add_id(command_line::DeclaredOptions& options, const char* key, int& id,
                                            const std::string& meaning);

/// Declares `name`, which is required.
command_line::DeclaredOptions::Added add_name(command_line::DeclaredOptions& options, std::string& name,
                                              const std::string& meaning);

/// Options of a program's participation in a run.
struct Participation {
  std::string lcm_url;
  double period_s = 0.1;
  double join_timeout_s = 30;
  bool in_lockstep = true;  ///< false: the run does not wait for the program, whose ticks are those of sim.clock
  double rewind_s = 60;     ///< longest rewind, in simulated time; 0: none

  void declare(command_line::DeclaredOptions& options);
};

/// Joins or follows the run and calls `decide` at each tick, until the run ends or a signal arrives.  After a rewind of
/// the world, `memory` restores the program's state.  Returns the exit code.
int take_part(shoal::Client& client, const Participation& participation, Memory memory,
              const std::function<void(std::int64_t utime)>& decide);

/// Does the same for a program whose complete state is `state`.
template <class State>
int take_part(shoal::Client& client, const Participation& participation, State& state,
              const std::function<void(std::int64_t utime)>& decide) {
  return take_part(client, participation, Memory(state, participation.rewind_s), decide);
}

/// Runs a program: reports std::invalid_argument and sim::ConfigError as wrong usage, any other exception as a
/// bus error.
int run_program(const char* name, const std::function<int()>& program);

}  // namespace autonomy
