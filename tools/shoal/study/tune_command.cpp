// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "experiment/campaign/tune.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_rules.hpp"
#include "experiment/study/study_tables.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/study/study_parts.hpp"

namespace tools {

namespace {

struct TuneArguments {
  std::string path, seeds, goal = "min";
  experiment::StudyChanges changes;
  experiment::TuneOptions options;
};

std::string values_of(const experiment::Tuning& tuning, const experiment::TunedPoint& point) {
  return experiment::values_text(tuning.study().config, tuning.study().points[point.point]);
}

/// Returns `a rule of its world fails in 2 of 4 runs`; empty: in none.
std::string failed_text(const experiment::TunedPoint& point) {
  if (point.failed == 0) return {};
  return fmt::format("a rule of its world fails in {} of {} runs", point.failed, point.runs);
}

/// Throws CLI::ValidationError for a figure that no metric of the world has.
void check_figure(const experiment::LoadedStudy& study, const std::string& figure) {
  if (figure == experiment::passed_figure) return;
  for (const sim::LoadedWorld& world : study.worlds)
    if (const auto problem = sim::figure_problem(world.config.metrics, figure))
      throw CLI::ValidationError("--figure", problem->text);
}

int tune(TuneArguments& arguments) {
  experiment::TuneOptions& options = arguments.options;
  arguments.changes.tuned = true;
  experiment::LoadedStudy study = experiment::load_study(
      experiment::file_by_name({experiment::ShippedKind::study}, arguments.path), arguments.changes);
  check_figure(study, options.figure);
  if (options.study.output.empty()) options.study.output = "results/" + study.config.name + "_tune";
  options.study.allow_paths = arguments.changes.load.allow_paths;
  options.maximize = arguments.goal == "max";
  choose_jobs(study, options.study);
  experiment::catch_signals(true);
  try {
    experiment::Tuning tuning(std::move(study), options);
    const std::string table = options.study.output + "/tune.csv";
    experiment::make_folders(options.study.output, options.study.output);
    // What cannot be written is refused before the first run.
    experiment::refuse_links(options.study.output, table);
    experiment::check_whole_file(table);
    tuning.run([&](int generation) {
      // After each generation, so that the table is whole when the search is interrupted.
      experiment::write_whole_file(table, tuning.to_csv());
      const experiment::TunedPoint& best = *tuning.best();
      const std::string failed = best.failed > 0 ? "; FAILED: " + failed_text(best) : "";
      std::cout << fmt::format("generation {}: {} of {} {:.6g}: {}{}\n", generation, options.statistic, options.figure,
                               best.value, values_of(tuning, best), failed)
                << std::flush;
    });
    if (experiment::caught_signal() != 0) {
      std::cerr << "shoal: stopped; the same command continues with the missing runs\n";
      return 128 + experiment::caught_signal();
    }
    const experiment::TunedPoint& best = *tuning.best();
    std::cout << "best of " << tuning.tried().size() << " points: " << values_of(tuning, best) << '\n'
              << tuning.command(best) << '\n';
    if (best.failed > 0) std::cout << "FAILED: " << failed_text(best) << " at the best point\n";
    if (!options.study.quiet) std::cerr << "all points in " << table << '\n';
    return best.failed > 0 ? exit_failed : exit_ok;
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const sim::ConfigError*>(&error) != nullptr) throw;
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

}  // namespace

static void add_tune_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("tune");
  const auto arguments = std::make_shared<TuneArguments>();
  experiment::TuneOptions& options = arguments->options;
  options.study.jobs = 0;
  options.study.threads = 0;
  // Options.
  CLI::Option* log_level = add_log_level_option(*command, "warn");
  command->add_option("STUDY", arguments->path, "study file with factors that are ranges")->required();
  command->add_option("--figure", options.figure, "figure of the runs, such as cooperative.rms_m")
      ->type_name("METRIC.FIGURE")
      ->required();
  command->add_option("--goal", arguments->goal, "whether the smallest or largest value is best")
      ->type_name("GOAL")
      ->check(one_of({"min", "max"}));
  command->add_option("--over", options.statistic, "statistic over the cases and seeds of a point")
      ->type_name("STATISTIC")
      ->check(one_of(experiment::statistic_words()));
  command->add_option("--generations", options.generations, "of the search")
      ->type_name("N")
      ->check(whole_from(1, 10000));
  command
      ->add_option("--population", options.population, "points of a generation; 0: 4 + 3 ln of the number of factors")
      ->type_name("N")
      ->check(whole_from(0, 1000));
  command->add_option("--sigma", options.sigma, "initial standard deviation, as a fraction of each range")
      ->type_name("SHARE")
      ->check(number_from(0.001, 1));
  command->add_option("--search-seed", options.seed, "seed of the search")
      ->type_name("N")
      ->check(whole_from(0, 9007199254740992));
  command->add_option("--seeds", arguments->seeds, "seeds of the runs, instead of those of the study")
      ->type_name("SEEDS");
  command->add_option("--duration", arguments->changes.duration_s, "simulated seconds of each run")
      ->type_name("S")
      ->check(number_from(1e-6, 1e9));
  command->add_option("--output", options.study.output, "output folder; default results/STUDY_tune")->type_name("DIR");
  add_jobs_options(*command, options.study);
  add_allow_path_option(*command, arguments->changes.load);
  add_plugin_option(*command);
  command_line::set_help_end(
      *command,
      {{"shoal tune balance_gains.yaml --figure balance.pitch_std_deg --generations 10 --jobs 2"},
       {{0, "a best point was found"},
        {1, "rules of the world fail at the best point"},
        {2, "wrong usage, or a mistake in the study or its world"},
        {4, "no point has a value, or a file error"},
        {130, "ended by Ctrl-C"}},
       {"The search is CMA-ES and starts in the middle of each range. A point where fewer runs break the rules "
        "of their world is better, whatever the figure. After Ctrl-C or a kill the "
        "same command continues: finished runs are not repeated."}});
  command->callback([arguments, log_level, &exit_code] {
    if (log_level->count() > 0 && !sim::log_shows(sim::LogLevel::info)) arguments->options.study.quiet = true;
    try {
      if (!arguments->seeds.empty()) arguments->changes.seeds = experiment::parse_seeds(arguments->seeds);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError("--seeds", error.what());
    }
    exit_code = tune(*arguments);
  });
}

SHOAL_COMMAND(measure, "tune", "Search for the settings of a study that make a figure best", add_tune_command);

}  // namespace tools
