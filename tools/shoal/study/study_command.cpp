// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "experiment/campaign/manifest.hpp"
#include "experiment/campaign/verified_runs.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_results.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "sim/base/log.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/study/study_parts.hpp"

namespace tools {

namespace {

/// Loads a study by its path or name.
experiment::LoadedStudy study_named(const std::string& path, const experiment::StudyChanges& changes) {
  try {
    return experiment::load_study(experiment::file_by_name({experiment::ShippedKind::study}, path), changes);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--algorithm", error.what());
  }
}

int study(const std::string& path, const experiment::StudyChanges& changes, experiment::StudyOptions options) {
  experiment::LoadedStudy loaded = study_named(path, changes);
  if (options.output.empty()) options.output = usual_output(loaded, changes);
  options.allow_paths = changes.load.allow_paths;
  choose_jobs(loaded, options);
  require_algorithms(loaded);
  experiment::catch_signals(true);
  try {
    std::vector<experiment::StudyRun> runs = experiment::plan_study(loaded, options.output);
    // The manifest is written before the first run, so that an interrupted study can be continued by `shoal study
    // run`.
    experiment::write_manifest(options.output, loaded, runs);
    experiment::check_outputs(options.output, loaded.config);
    experiment::StudyProgress progress{runs.size()};
    experiment::run_in_batches(loaded, runs, [&](const std::vector<std::size_t>& which) {
      experiment::run_study(loaded, options, runs, which, progress);
    });
    if (experiment::caught_signal() != 0) {
      std::cerr << "shoal: stopped; the same command continues with the missing runs\n";
      return 128 + experiment::caught_signal();
    }
    return collect_results(loaded, runs, options.output, options.quiet);
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

/// Compares the table of algorithms with the runs that it is made of.  Returns the number of differences.
std::size_t verify_table(const experiment::LoadedStudy& study, const std::vector<experiment::StudyRow>& rows,
                         const std::string& directory, const std::vector<std::string>& cases) {
  const std::string path = directory + "/algorithms.csv";
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    std::cout << "there is no algorithms.csv to compare with study.csv\n";
    return 0;
  }
  const experiment::VerifiedTable verified =
      experiment::compare_with_table(study, rows, experiment::read_whole_file(path), path, cases);
  constexpr std::size_t max_shown = 5;
  for (std::size_t i = 0; i < std::min(max_shown, verified.differences.size()); ++i)
    std::cout << verified.differences[i] << '\n';
  if (verified.differences.size() > max_shown) std::cout << "...\n";
  std::cout << (verified.differences.empty()
                    ? fmt::format("algorithms.csv: {} rows are those of study.csv\n", verified.rows)
                    : fmt::format("algorithms.csv: DIFFERS from study.csv in {} values\n",
                                  verified.differences.size()));
  return verified.differences.size();
}

/// Executes runs again and compares them with those of a table, perhaps of someone else.
int verify(const std::string& path, const experiment::StudyChanges& changes, experiment::StudyOptions options,
           const std::string& directory, const std::vector<std::string>& cases) {
  const experiment::LoadedStudy loaded = study_named(path, changes);
  for (const std::string& name : cases)
    if (std::none_of(loaded.config.cases.begin(), loaded.config.cases.end(),
                     [&](const experiment::StudyCase& each) { return each.name == name; }))
      throw CLI::ValidationError("--case", "the study has no case '" + name + "'");
  if (options.output.empty()) options.output = usual_output(loaded, changes) + "_verified";
  options.allow_paths = changes.load.allow_paths;
  options.fresh = true;
  choose_jobs(loaded, options);
  require_algorithms(loaded);
  experiment::catch_signals(true);
  try {
    const std::string table = directory + "/study.csv";
    const std::vector<experiment::StudyRow> rows =
        experiment::parse_study_rows(experiment::read_whole_file(table), table);
    std::vector<experiment::StudyRun> runs = experiment::plan_study(loaded, options.output);
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (cases.empty() ||
          std::find(cases.begin(), cases.end(), loaded.config.cases[runs[i].in_case].name) != cases.end())
        which.push_back(i);
    const std::size_t different = experiment::verify_runs(loaded, options, runs, which, rows) +
                                  (loaded.config.algorithms.empty() ? 0 : verify_table(loaded, rows, directory, cases));
    if (experiment::caught_signal() != 0) return 128 + experiment::caught_signal();
    return different > 0 ? exit_failed : exit_ok;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

int plan(const std::string& path, const experiment::StudyChanges& changes, std::string output) {
  const experiment::LoadedStudy loaded = study_named(path, changes);
  if (output.empty()) output = usual_output(loaded, changes);
  require_algorithms(loaded);
  try {
    const std::vector<experiment::StudyRun> runs = experiment::plan_study(loaded, output);
    experiment::write_manifest(output, loaded, runs);
    std::cout << fmt::format("{}: {} runs: {} cases, {} points, {} seeds\n", experiment::manifest_path(output),
                             runs.size(), loaded.config.cases.size(), loaded.points.size(), loaded.config.seeds.size());
    return exit_ok;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

/// Adds the options that change what a study file says.
void add_change_options(CLI::App& command, std::string& seeds, experiment::StudyChanges& changes, std::string& output) {
  command.add_option("--seeds", seeds, "seeds instead of those of the study: 7, 1-10 or 1-3,8")->type_name("SEEDS");
  command
      .add_option("--duration", changes.duration_s, "shorten every run to this simulated duration, s, for a quick look")
      ->type_name("S")
      ->check(number_from(1e-6, 1e9));
  command.add_option("--output", output, "output folder; default results/STUDY, with --duration 10 results/STUDY_10s")
      ->type_name("DIR");
}

void take_seeds(const std::string& seeds, experiment::StudyChanges& changes) {
  try {
    if (!seeds.empty()) changes.seeds = experiment::parse_seeds(seeds);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--seeds", error.what());
  }
}

void add_study_plan_command(CLI::App& study_command, int& exit_code) {
  CLI::App* command = study_command.add_subcommand("plan", "Write the list of runs of a study without running them");
  struct Arguments {
    std::string path, seeds, output;
    experiment::StudyChanges changes;
  };
  const auto arguments = std::make_shared<Arguments>();
  add_log_level_option(*command, "warn");
  command->add_option("STUDY", arguments->path, "study file, see docs/guides/campaigns.md")->required();
  add_change_options(*command, arguments->seeds, arguments->changes, arguments->output);
  add_algorithm_option(*command, arguments->changes);
  add_allow_path_option(*command, arguments->changes.load);
  add_plugin_option(*command);
  command_line::set_help_end(*command, {{"shoal study plan coop_land --output results/sweep"},
                                        {{0, "the list is in DIR/manifest.jsonl"},
                                         {2, "wrong usage, or a mistake in the study or its world"},
                                         {4, "a file error"}},
                                        {}});
  command->callback([arguments, &exit_code] {
    take_seeds(arguments->seeds, arguments->changes);
    exit_code = plan(arguments->path, arguments->changes, arguments->output);
  });
}

}  // namespace

static void add_study_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("study");
  struct Arguments {
    std::string path, seeds;
    std::string verified;
    std::vector<std::string> cases;
    experiment::StudyChanges changes;
    experiment::StudyOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  arguments->options.jobs = 0;
  arguments->options.threads = 0;
  // Options.
  CLI::Option* log_level = add_log_level_option(*command, "warn");
  CLI::Option* path = command->add_option("STUDY", arguments->path, "study file, see docs/guides/studies.md");
  add_change_options(*command, arguments->seeds, arguments->changes, arguments->options.output);
  add_jobs_options(*command, arguments->options);
  add_algorithm_option(*command, arguments->changes);
  CLI::Option* verified =
      command
          ->add_option("--verify", arguments->verified,
                       "execute the runs again and compare them with study.csv in this folder, bit for bit")
          ->type_name("DIR")
          ->check(command_line::not_empty());
  command_line::add_name_list(*command, "--case", arguments->cases, "with --verify: only these cases")->needs(verified);
  add_allow_path_option(*command, arguments->changes.load);
  add_plugin_option(*command);
  // Steps of a study.
  add_study_plan_command(*command, exit_code);
  add_study_run_command(*command, exit_code);
  add_study_collect_command(*command, exit_code);
  // End of the help and action.
  command_line::set_help_end(*command,
                             {{"shoal study worlds/studies/coop_land.yaml --jobs 2",
                               "shoal study worlds/studies/coop_underwater.yaml --seeds 1-2 --duration 60",
                               "shoal report results/coop_land", "shoal study plan coop_land --output results/sweep",
                               "shoal study run results/sweep --engine slurm", "shoal study collect results/sweep",
                               "shoal study benchmark --verify results/benchmark --case 03_team_dive --seeds 1003"},
                              {{0, "no rule of the study failed; with --verify all runs are equal"},
                               {1, "a rule of the study failed; with --verify a run differs"},
                               {2, "wrong usage, or a mistake in the study or its world"},
                               {4, "a run has no result, or a file error"},
                               {130, "ended by Ctrl-C"}},
                              {"After Ctrl-C the same command continues with the missing runs.",
                               "`shoal study STUDY` is `plan`, `run` and `collect` in one. A study file named like one "
                               "of these commands needs "
                               "its folder or ending: ./plan.yaml"}});
  command->callback([command, path, arguments, log_level, &exit_code] {
    if (!command->get_subcommands().empty()) return;
    if (path->count() == 0) throw command_line::UsageError("STUDY is required, or a command: plan, run or collect");
    if (log_level->count() > 0 && !sim::log_shows(sim::LogLevel::info)) arguments->options.quiet = true;
    take_seeds(arguments->seeds, arguments->changes);
    if (!arguments->verified.empty())
      exit_code =
          verify(arguments->path, arguments->changes, arguments->options, arguments->verified, arguments->cases);
    else
      exit_code = study(arguments->path, arguments->changes, arguments->options);
  });
}

SHOAL_COMMAND(measure, "study", "Run a world with many seeds and settings, and compare", add_study_command);

}  // namespace tools
