#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bridges/lcm/bus_error.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/device/device_registry.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/shoal/bug_command.hpp"
#include "tools/shoal/commands.hpp"

namespace {

/// `--eye -4,2,1` as `--eye=-4,2,1`: CLI11 would take the value for an option.  In the order that CLI11 wants, the last
/// argument first.
std::vector<std::string> joined_negative_values(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const bool negative = text.size() > 1 && text[0] == '-' && std::string("0123456789.").find(text[1]) != text.npos;
    const bool after_option = !arguments.empty() && arguments.back().starts_with("--") && arguments.back() != "--" &&
                              arguments.back().find('=') == std::string::npos;
    if (negative && after_option)
      arguments.back() += "=" + text;
    else
      arguments.push_back(text);
  }
  std::reverse(arguments.begin(), arguments.end());
  return arguments;
}

int run(int argc, char** argv) {
  CLI::App app{"Shoal simulates many vehicles and their devices on LCM channels."};
  app.set_version_flag("--version", tools::version_text);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  shoal run worlds/minimal.yaml --duration 10\n"
      "  shoal run worlds/coop_land.yaml --launch --results results/coop_land\n"
      "  shoal check worlds/coop_land.yaml\n"
      "  shoal snap worlds/coop_land.yaml --at 10 --out coop_land.png\n"
      "  shoal describe lidar\n"
      "`shoal COMMAND --help` tells more.\n"
      "Exit codes: 0 ok, 1 a pass rule of the world failed, 2 usage or configuration, 3 physics fault,\n"
      "4 bus or file trouble, 5 time-out, 129 SIGHUP, 130 SIGINT, 143 SIGTERM.");
  for (const std::string& problem : sim::DeviceRegistry::instance().take_problems())
    throw std::logic_error("this program was built wrong: " + problem);
  int exit_code = tools::exit_ok;
  tools::add_run_command(app, exit_code);
  tools::add_replay_command(app, exit_code);
  tools::add_check_command(app, exit_code);
  tools::add_snap_command(app, exit_code);
  tools::add_snapshot_command(app, exit_code);
  tools::add_describe_command(app, exit_code);
  tools::add_list_command(app, exit_code);
  tools::add_spy_command(app, exit_code);
  tools::add_control_command(app, exit_code);
  tools::add_doctor_command(app, exit_code);
  tools::add_log_command(app, exit_code);
  tools::add_bench_command(app, exit_code);
  tools::add_mesh_command(app, exit_code);
  tools::add_medium_command(app, exit_code);
  tools::add_fidelity_command(app, exit_code);
  tools::add_acoustics_command(app, exit_code);
  tools::add_report_command(app, exit_code);
  tools::add_bug_command(app, exit_code);
  tools::add_study_command(app, exit_code);
  try {
    app.parse(joined_negative_values(argc, argv));
  } catch (const CLI::ParseError& error) {
    // CLI11 has exit codes of its own; all that is not help or version is wrong usage.
    return app.exit(error) == 0 ? tools::exit_ok : tools::exit_usage;
  } catch (const sim::ConfigError& error) {
    for (const std::string& line : error.lines()) std::cerr << line << '\n';
    return tools::exit_usage;
  } catch (const bridges::BusError& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return tools::exit_bus;
  }
  return exit_code;
}

/// A full disk shows at the latest now.  What failed before is the more important code.
int flush_output(int exit_code) {
  const bool flushed = std::fflush(stdout) == 0;
  const int error = flushed ? EIO : errno;
  if (flushed && std::cout && std::ferror(stdout) == 0) return exit_code;
  std::cerr << "shoal: cannot write to stdout: " << std::strerror(error) << '\n';
  return exit_code == tools::exit_ok ? tools::exit_bus : exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // Data goes to stdout, words for people to stderr.
  spdlog::set_default_logger(spdlog::stderr_color_mt("shoal"));
  spdlog::set_pattern("%^%l%$: %v");
  try {
    return flush_output(run(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return tools::exit_bus;
  }
}
