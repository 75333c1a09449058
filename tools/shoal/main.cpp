// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/base/bus_error.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "sim/base/text_layout.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/file_access.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world_file/vehicle_config.hpp"
#include "tools/command_line/parse.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace {

volatile std::sig_atomic_t output_was_closed = 0;

/// Versions of the program, its libraries and the files that it reads, and where the shipped ones are.
std::string versions() {
  const std::string shipped = sim::shipped_folder();
  return experiment::version_text() + "machine: " + experiment::build_text() +
         "\nworlds and vehicles: " + (shipped.empty() ? "none were found" : shipped) + ", format " +
         std::to_string(sim::VehicleConfig{}.shoal) + "\n";
}

/// Returns the first argument that may name a command: `film` of `shoal help film`.
std::string called_command(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (argv[i][0] != '-' && std::string_view(argv[i]) != "help") return argv[i];
  return {};
}

/// Continues as a program that is called as a command: with the words after its name, or to print its help.
[[noreturn]] void become(std::string program, int argc, char** argv) {
  std::string ask = "--help";
  std::vector<char*> words{program.data()};
  if (std::string_view(argv[1]) == "help")
    words.push_back(ask.data());
  else
    words.insert(words.end(), argv + 2, argv + argc);
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  throw std::runtime_error(program + " cannot be started: " + std::strerror(errno));
}

int run(int argc, char** argv) {
  CLI::App app{"Shoal simulates many vehicles and their devices on LCM channels.", "shoal"};
  // General options and help.
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", versions, "print the versions of Shoal, its libraries and its files");
  app.require_subcommand(1);
  command_line::set_help_end(
      app,
      {{"shoal run worlds/minimal.yaml --duration 10",
        "shoal run worlds/coop_land.yaml --launch --results results/coop_land", "shoal check worlds/coop_land.yaml",
        "shoal snap worlds/coop_land.yaml --at 10 --out coop_land.png", "shoal describe lidar"},
       {{0, "success"},
        {1, "a pass rule failed, or a comparison found a difference"},
        {2, "wrong usage, or an error in an input file"},
        {3, "physics fault"},
        {4, "bus or file error"},
        {5, "time-out"},
        {129, "ended by SIGHUP; 130 by SIGINT; 143 by SIGTERM"}},
       {"`shoal COMMAND --help` has the options and exit codes of a command.",
        "A program shoal-NAME in PATH is the command `shoal NAME`."}});
  for (const std::string& problem : sim::DeviceRegistry::instance().take_problems())
    throw std::logic_error("this program was built wrong: " + problem);
  // Commands: all are named, and the one that is called is complete.
  int exit_code = tools::exit_ok;
  tools::list_commands(app);
  const std::string called = called_command(argc, argv);
  const bool is_first = argc > 1 && argv[1][0] != '-';
  if (const std::string program = tools::outside_command(called); is_first && !program.empty())
    become(program, argc, argv);
  if (const std::string call = tools::meant_call(called); !call.empty()) {
    std::cerr << "shoal: unknown command '" << called << "'; use " << call << "\nSee `shoal --help`.\n";
    return tools::exit_usage;
  }
  tools::complete_command(app, exit_code, called);
  // Parse and run.
  try {
    if (const auto ended = command_line::parse(app, argc, argv)) return *ended;
  } catch (const sim::ConfigError& error) {
    for (const std::string& line : error.lines()) std::cerr << line << '\n';
    return tools::exit_usage;
  } catch (const bridges::BusError& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return tools::exit_bus;
  }
  return exit_code;
}

/// Flushes the output and reports a full disk.  An earlier failure has the more important code.  A reader that closes
/// the output early, such as `head -1`, is not a failure.
int flush_output(int exit_code) {
  errno = 0;
  const bool flushed = std::cout.flush() && std::fflush(stdout) == 0;
  int error = errno;
  if ((flushed && std::ferror(stdout) == 0) || error == EPIPE || output_was_closed) return exit_code;
  // The reason of an earlier failed write is lost: another write fails for the same reason.
  if (error == 0 && write(STDOUT_FILENO, "\n", 1) < 0) error = errno;
  std::cerr << "shoal: cannot write to stdout: " << std::strerror(error != 0 ? error : EIO) << '\n';
  return exit_code == tools::exit_ok ? tools::exit_bus : exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // Data is written to stdout, messages to stderr.
  const bool color = sim::may_use_color(STDERR_FILENO);
  spdlog::set_default_logger(
      spdlog::stderr_color_mt("shoal", color ? spdlog::color_mode::automatic : spdlog::color_mode::never));
  // On a terminal a message replaces the live line of progress.
  const bool clears = sim::can_move_cursor(STDERR_FILENO);
  spdlog::set_pattern(clears ? "\r\x1b[K%^%l%$: %v" : "%^%l%$: %v");
  // A closed pipe is reported as a failed write.  A handler is used, because child programs would inherit an ignored
  // signal.
  std::signal(SIGPIPE, [](int) { output_was_closed = 1; });
  try {
    return flush_output(run(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return tools::exit_bus;
  }
}
