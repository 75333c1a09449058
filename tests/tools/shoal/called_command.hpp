// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "sim/config/diagnostics.hpp"
#include "tools/command_line/parse.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace test {

/// What a command did.
struct Called {
  int exit_code = 0;
  std::string out, err;
};

/// Calls a command of shoal that these tests are linked with, as main() does.  An option that is not given keeps the
/// value of the call before.
inline Called call_shoal(const std::vector<std::string>& words) {
  static CLI::App app{"Simulates.", "shoal"};
  static int exit_code = 0;
  [[maybe_unused]] static const bool complete = [] {
    app.require_subcommand(1);
    tools::list_commands(app);
    tools::complete_command(app, exit_code, "run");  // of no library: adds those that are linked
    return true;
  }();
  std::vector<const char*> arguments{"shoal"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  exit_code = tools::exit_ok;
  Called called;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    const auto ended = command_line::parse(app, static_cast<int>(arguments.size()), arguments.data());
    called.exit_code = ended.value_or(exit_code);
  } catch (const sim::ConfigError& error) {
    for (const std::string& line : error.lines()) std::cerr << line << '\n';
    called.exit_code = tools::exit_usage;
  } catch (const std::exception& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    called.exit_code = tools::exit_bus;
  }
  std::cout << std::flush;
  called.out = testing::internal::GetCapturedStdout();
  called.err = testing::internal::GetCapturedStderr();
  return called;
}

}  // namespace test
