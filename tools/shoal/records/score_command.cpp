// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "experiment/log_score/log_score.hpp"
#include "experiment/run/runner.hpp"
#include "sim/base/log.hpp"
#include "sim/config/diagnostics.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

struct ScoreArguments {
  experiment::LogScoreOptions score;
  std::string json;
};

int score(const ScoreArguments& arguments) {
  if (!arguments.json.empty()) check_writable(arguments.json);
  experiment::catch_signals(true);
  const experiment::LogScore result = experiment::score_log(arguments.score);
  std::cout << result.to_text();
  if (!arguments.json.empty() && !(std::ofstream(arguments.json) << result.to_json() << std::flush))
    throw std::runtime_error("'" + arguments.json + "' cannot be written");
  if (result.interrupted) return 128 + experiment::caught_signal();
  for (const experiment::RuleVerdict& verdict : result.verdicts)
    if (!verdict.passed) return exit_failed;
  return exit_ok;
}

}  // namespace

static void add_score_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("score");
  const auto arguments = std::make_shared<ScoreArguments>();
  experiment::LogScoreOptions& options = arguments->score;
  CLI::Option* log_level = add_log_level_option(*command, "error");
  command->add_option("LOG", options.log, "log of shoal run --record")->required();
  CLI::Option* estimate =
      command->add_option("--estimate", options.estimate, "TUM file, or CSV with the columns t, x, y and further ones")
          ->type_name("FILE");
  command->add_option("--metric", options.metric, "position_error whose estimates the file replaces")
      ->type_name("NAME")
      ->needs(estimate);
  command->add_option("--json", arguments->json, "file for figures and rules")->type_name("FILE");
  command->add_option("--tum", options.tum, "folder for the true trajectories and the scored estimates as TUM files")
      ->type_name("DIR");
  command
      ->add_option(
          "--mrclam", options.mrclam,
          "folder for truth, odometry and range-bearing measurements in the format of the UTIAS MR.CLAM data sets")
      ->type_name("DIR");
  add_set_option(*command, options.load.sets);
  add_allow_path_option(*command, options.load);
  add_threads_option(*command, options.threads);
  add_plugin_option(*command);
  command->add_flag("--quiet", options.quiet, "no progress");
  command_line::set_help_end(*command, {{"shoal score run.lcm --json scores.json",
                                         "shoal score run.lcm --estimate mine.csv --metric cooperative",
                                         "shoal score run.lcm --tum trajectories"},
                                        {{0, "all rules hold"},
                                         {1, "a rule of the world fails"},
                                         {2, "wrong usage, or a mistake in the world or the file"},
                                         {4, "the log lacks data that a replay needs, or a file error"},
                                         {130, "ended by Ctrl-C"}},
                                        {"The world of the log is replayed, so that all metrics are available as in "
                                         "the run.  docs/guides/scoring.md has the "
                                         "columns of --estimate."}});
  command->callback([arguments, log_level, &exit_code] {
    if (log_level->count() > 0 && !sim::log_shows(sim::LogLevel::info)) arguments->score.quiet = true;
    try {
      exit_code = score(*arguments);
    } catch (const sim::ConfigError&) {
      throw;
    } catch (const std::invalid_argument& error) {
      throw command_line::UsageError(error.what());
    } catch (const std::runtime_error& error) {
      std::cerr << "shoal: " << error.what() << '\n';
      exit_code = exit_bus;
    }
  });
}

SHOAL_COMMAND(measure, "score", "Score a log again, or an estimate that was made elsewhere", add_score_command);

}  // namespace tools
