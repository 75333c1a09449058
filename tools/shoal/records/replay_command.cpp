// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>
#include <memory>

#include "bridges/lockstep/lockstep_service.hpp"
#include "experiment/replay/play.hpp"
#include "experiment/replay/replay.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "sim/base/log.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

struct ReplayArguments {
  experiment::ReplayOptions replay;
  std::string report;
  bool play = false;
  std::string speed = "max";
  experiment::PlayOptions player;
};

constexpr std::size_t max_lines = 60;

int run(ReplayArguments& arguments) {
  if (!arguments.replay.world.empty()) arguments.replay.world = experiment::world_file(arguments.replay.world);
  // Checked before the replay, which may take hours.
  if (!arguments.report.empty()) check_writable(arguments.report);
  experiment::catch_signals(true);
  const experiment::ReplayOutcome outcome = experiment::replay(arguments.replay);
  std::cout << outcome.to_text();
  for (std::size_t i = 0; i < outcome.report.size() && arguments.report.empty(); ++i) {
    if (i == max_lines) {
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
  return outcome.interrupted ? 128 + experiment::caught_signal() : outcome.exit_code();
}

int run_player(ReplayArguments& arguments) {
  experiment::PlayOptions& player = arguments.player;
  player.log = arguments.replay.log;
  player.until_s = arguments.replay.until_s;
  player.quiet = arguments.replay.quiet;
  player.speed = parse_speed(arguments.speed).value_or(0);
  experiment::catch_signals(true);
  try {
    const experiment::PlayOutcome outcome = experiment::play(player);
    std::cout << outcome.text;
    return outcome.exit_code;
  } catch (const experiment::RunError& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return error.exit_code;
  } catch (const bridges::LockstepTimeout& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_timeout;
  }
}

void add_player_options(CLI::App& command, ReplayArguments& arguments) {
  CLI::Option* play = command.add_flag("--play", arguments.play, "play the record to programs, without a world");
  experiment::PlayOptions& player = arguments.player;
  const auto of_play = [&](CLI::Option* option) { return option->needs(play); };
  of_play(command_line::add_name_list(command, "--await", player.await, "lockstep clients to wait for: NAME,NAME,...")
              ->type_name("NAMES"));
  of_play(
      command.add_option("--join-timeout", player.join_timeout_s, "wall seconds to wait for clients; 0: start at once")
          ->type_name("S")
          ->check(number_from(0, 1e9)));
  of_play(command.add_option("--speed", arguments.speed, "times real time, or max")
              ->type_name("FACTOR")
              ->capture_default_str());
  of_play(add_lcm_url_option(command, player.lcm_url));
  of_play(command.add_flag("--compare", player.compare, "exit code 1 if a program publishes something else"));
  for (const char* other : {"--world", "--set", "--report", "--threads"}) play->excludes(command.get_option(other));
}

}  // namespace

static void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("replay");
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::Option* log_level = add_log_level_option(*command, "error");
  command->add_option("LOG", arguments->replay.log, "log of shoal run --record, or of lcm-logger")->required();
  command->add_option("--world", arguments->replay.world, "use this world file instead of the world of the log")
      ->type_name("FILE");
  add_set_option(*command, arguments->replay.load.sets);
  add_allow_path_option(*command, arguments->replay.load);
  command->add_option("--until", arguments->replay.until_s, "simulated seconds; default: to the end of the log")
      ->type_name("S")
      ->check(number_from(0, 1e9));
  command->add_option("--report", arguments->report, "write all differences to this file")->type_name("FILE");
  add_threads_option(*command, arguments->replay.threads);
  add_plugin_option(*command);
  add_player_options(*command, *arguments);
  command->add_flag("--quiet", arguments->replay.quiet, "no progress");
  // End of the help.
  command_line::set_help_end(
      *command,
      {{"shoal replay run.lcm",
        "shoal replay run.lcm --set vehicles.rover3.devices.imu.rate_hz=50 --report differences.txt",
        "shoal replay run.lcm --play --await rover3 --compare",
        "shoal replay run.lcm --play --join-timeout 0 --speed 1"},
       {{0, "equal; with --play: played"},
        {1, "different; with --play only when --compare was given"},
        {2, "wrong usage, or a mistake in the world"},
        {4, "the log lacks data that a replay needs, or a file or bus error"},
        {5, "with --play: no program connected, or one did not answer in time"},
        {130, "ended by Ctrl-C"}},
       {"With --play the messages of a record are sent to programs as in its run: in lockstep to those that join, and "
        "on the bus to those that only listen. What they publish changes nothing; it is compared with the record."}});
  // Action.
  command->callback([arguments, log_level, &exit_code] {
    if (log_level->count() > 0 && !sim::log_shows(sim::LogLevel::info)) arguments->replay.quiet = true;
    if (log_level->count() == 0 && arguments->play) sim::set_log_level("warn");
    try {
      exit_code = arguments->play ? run_player(*arguments) : run(*arguments);
    } catch (const sim::ConfigError&) {
      throw;
    } catch (const std::runtime_error& error) {
      std::cerr << "shoal: " << error.what() << '\n';
      exit_code = exit_bus;
    }
  });
}

SHOAL_COMMAND(run, "replay", "Replay the world of a log, and compare", add_replay_command);

}  // namespace tools
