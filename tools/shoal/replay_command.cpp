#include <spdlog/spdlog.h>

#include <fstream>
#include <iostream>
#include <memory>

#include "bridges/lcm/lockstep_service.hpp"
#include "tools/experiment/play.hpp"
#include "tools/experiment/replay.hpp"
#include "tools/experiment/run_error.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/shoal/commands.hpp"
#include "tools/shoal/output_file.hpp"
#include "tools/shoal/speed_option.hpp"

namespace tools {

namespace {

struct ReplayArguments {
  ReplayOptions replay;
  std::string report, log_level = "error";
  bool play = false;
  std::string speed = "max";
  PlayOptions player;
};

constexpr std::size_t most_lines = 60;

int run(ReplayArguments& arguments) {
  spdlog::set_level(spdlog::level::from_str(arguments.log_level));
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

int run_player(ReplayArguments& arguments, bool log_level_given) {
  spdlog::set_level(spdlog::level::from_str(log_level_given ? arguments.log_level : "warn"));
  PlayOptions& player = arguments.player;
  player.log = arguments.replay.log;
  player.until_s = arguments.replay.until_s;
  player.quiet = arguments.replay.quiet;
  player.speed = parse_speed(arguments.speed).value_or(0);
  catch_signals(true);
  try {
    const PlayOutcome outcome = play(player);
    std::cout << outcome.text;
    return outcome.exit_code;
  } catch (const RunError& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return error.exit_code;
  } catch (const bridges::LockstepTimeout& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_timeout;
  }
}

void add_player_options(CLI::App& command, ReplayArguments& arguments) {
  CLI::Option* play = command.add_flag("--play", arguments.play, "play the record to programs, without a world");
  PlayOptions& player = arguments.player;
  const auto of_play = [&](CLI::Option* option) { return option->needs(play)->group("Options of --play"); };
  of_play(command.add_option("--await", player.await, "lockstep client to wait for; may be repeated")
              ->type_size(1)
              ->allow_extra_args(false));
  of_play(command
              .add_option("--join-timeout", player.join_timeout_s,
                          "wall seconds to wait for clients, 30 unless given; 0: start at once")
              ->check(number_from(0, 1e9)));
  of_play(command.add_option("--speed", arguments.speed, "times real time, or max (the default)"));
  of_play(command.add_option("--lcm-url", player.lcm_url, "LCM URL; without it LCM_DEFAULT_URL, then the default"));
  of_play(command.add_flag("--compare", player.compare, "exit code 1 when a program publishes something else"));
  for (const char* other : {"--world", "--set", "--report", "--threads"}) play->excludes(command.get_option(other));
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("replay", "Run the world of a log again, and compare");
  const auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("LOG", arguments->replay.log, "of shoal run --record, or of lcm-logger")->required();
  command->add_option("--world", arguments->replay.world, "a world file instead of the log's world");
  command->add_option("--set", arguments->replay.sets, "path=value: change a value of the world")
      ->type_size(1)
      ->allow_extra_args(false);
  command->add_option("--until", arguments->replay.until_s, "simulated seconds; without it to the end of the log")
      ->check(number_from(0, 1e9));
  command->add_option("--report", arguments->report, "file for all differences");
  command->add_option("--threads", arguments->replay.threads, "threads that follow rays; 0: one for each processor")
      ->check(CLI::Range(0, 256));
  add_plugin_option(*command);
  add_player_options(*command, *arguments);
  command->add_flag("--quiet", arguments->replay.quiet, "no progress");
  command->add_option("--log-level", arguments->log_level, "what is said on stderr")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}));
  command->footer(
      "Exit codes: 0 equal, 1 different, 4 the log does not tell enough.\n"
      "With --play the messages of a record go to programs as in its run: in lockstep\n"
      "to those that join, and on the bus to those that only listen. What they publish\n"
      "changes nothing; it is compared with the record. Exit codes: 0 played,\n"
      "1 something differs (--compare), 4 bus or record, 5 no program came or answered.\n"
      "Examples:\n"
      "  shoal replay run.lcm\n"
      "  shoal replay run.lcm --set vehicles.rover3.devices.imu.rate_hz=50 \\\n"
      "    --report differences.txt\n"
      "  shoal replay run.lcm --play --await rover3 --compare\n"
      "  shoal replay run.lcm --play --join-timeout 0 --speed 1");
  command->callback([arguments, command, &exit_code] {
    try {
      exit_code = arguments->play ? run_player(*arguments, command->count("--log-level") > 0) : run(*arguments);
    } catch (const sim::ConfigError&) {
      throw;
    } catch (const std::runtime_error& error) {
      std::cerr << "shoal: " << error.what() << '\n';
      exit_code = exit_bus;
    }
  });
}

}  // namespace tools
