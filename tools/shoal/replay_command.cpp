#include <spdlog/spdlog.h>

#include <fstream>
#include <iostream>
#include <memory>

#include "tools/experiment/replay.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/shoal/commands.hpp"
#include "tools/shoal/output_file.hpp"

namespace tools {

namespace {

struct ReplayArguments {
  ReplayOptions replay;
  std::string report;
};

constexpr std::size_t most_lines = 60;

int run(ReplayArguments& arguments) {
  if (!arguments.report.empty()) check_writable(arguments.report);
  catch_signals(true);
  const ReplayOutcome outcome = replay(arguments.replay);
  std::cout << outcome.to_text();
  for (std::size_t i = 0; i < outcome.report.size() && arguments.report.empty(); ++i) {
    if (i == most_lines) {
      std::cout << outcome.report.size() - i << " more lines; --report FILE writes all of them\n";
      break;
    }
    std::cout << outcome.report[i] << '\n';
  }
  if (!arguments.report.empty()) {
    std::ofstream out(arguments.report);
    out << outcome.to_text();
    for (const std::string& line : outcome.report) out << line << '\n';
    if (!out.flush()) throw std::runtime_error("'" + arguments.report + "' cannot be written");
  }
  return outcome.interrupted ? 128 + caught_signal() : outcome.exit_code();
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("replay", "Run the world of a log again, and compare");
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::Option* log_level = add_log_level_option(*command, "error");
  command->add_option("LOG", arguments->replay.log, "of shoal run --record, or of lcm-logger")->required();
  command->add_option("--world", arguments->replay.world, "a world file instead of the log's world")->type_name("FILE");
  add_set_option(*command, arguments->replay.sets);
  command->add_option("--until", arguments->replay.until_s, "simulated seconds; without it to the end of the log")
      ->type_name("S")
      ->check(number_from(0, 1e9));
  command->add_option("--report", arguments->report, "file for all differences")->type_name("FILE");
  add_threads_option(*command, arguments->replay.threads);
  add_plugin_option(*command);
  command->add_flag("--quiet", arguments->replay.quiet, "no progress");
  command_line::set_help_end(
      *command, {{"shoal replay run.lcm",
                  "shoal replay run.lcm --set vehicles.rover3.devices.imu.rate_hz=50 --report differences.txt"},
                 {{0, "equal"},
                  {1, "different"},
                  {2, "wrong usage, or a mistake in the world"},
                  {4, "the log has not what a replay needs, or file trouble"},
                  {130, "ended by Ctrl-C"}},
                 {}});
  command->callback([arguments, log_level, &exit_code] {
    if (log_level->count() > 0 && !spdlog::should_log(spdlog::level::info)) arguments->replay.quiet = true;
    try {
      exit_code = run(*arguments);
    } catch (const sim::ConfigError&) {
      throw;
    } catch (const std::runtime_error& error) {
      std::cerr << "shoal: " << error.what() << '\n';
      exit_code = exit_bus;
    }
  });
}

}  // namespace tools
