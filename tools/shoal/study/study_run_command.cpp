// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "experiment/campaign/engines.hpp"
#include "experiment/campaign/manifest.hpp"
#include "experiment/campaign/shown_runs.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/study/study_results.hpp"
#include "sim/base/log.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "tools/shoal/study/study_parts.hpp"

namespace tools {

namespace {

struct StudyRunArguments {
  std::string directory, indices, engine = "local";
  sim::LoadOptions load;
  experiment::StudyChanges changes;  ///< only its algorithms
  experiment::EngineOptions options;
  bool no_wait = false;
};

std::vector<std::size_t> chosen_runs(const StudyRunArguments& arguments, std::size_t size) {
  std::vector<std::size_t> all(size);
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (arguments.indices.empty()) return all;
  try {
    return experiment::parse_indices(arguments.indices, size);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--index", error.what());
  }
}

void execute(const StudyRunArguments& arguments, experiment::PlannedStudy& planned,
             const std::vector<std::size_t>& which, experiment::StudyProgress& progress) {
  const experiment::EngineOptions& options = arguments.options;
  if (arguments.engine == "local")
    return experiment::run_study(planned.study, options.study, planned.runs, which, progress);
  if (arguments.engine == "parallel")
    return experiment::run_by_parallel(planned.study, options, planned.runs, which, progress);
  experiment::run_by_slurm(planned.study, options, planned.runs, which, progress);
}

/// Reports what is left.  Returns the exit code.
int outcome(const StudyRunArguments& arguments, const experiment::PlannedStudy& planned,
            const std::vector<std::size_t>& which) {
  if (experiment::caught_signal() != 0) {
    std::cerr << "shoal: stopped; the same command continues with the missing runs\n";
    return 128 + experiment::caught_signal();
  }
  if (arguments.no_wait) return exit_ok;
  std::size_t failed = 0, missing = 0;
  for (const std::size_t i : which)
    if (!planned.runs[i].record) ++(planned.runs[i].tried ? failed : missing);
  if (failed > 0)
    std::cerr << fmt::format("{} runs failed; `shoal study collect {}` lists them\n", failed, arguments.directory);
  if (missing > 0) std::cerr << fmt::format("{} runs have no result; the same command continues with them\n", missing);
  return failed + missing > 0 ? exit_bus : exit_ok;
}

int run_planned(StudyRunArguments& arguments) {
  experiment::catch_signals(true);
  try {
    const experiment::Manifest manifest(arguments.directory);
    std::vector<std::size_t> which = chosen_runs(arguments, manifest.size());
    experiment::PlannedStudy planned = experiment::load_planned(manifest, arguments.load, arguments.changes.algorithms);
    experiment::check_planned(manifest, planned, which);
    experiment::StudyOptions& options = arguments.options.study;
    options.output = arguments.directory;
    options.any_version = true;
    options.allow_paths = arguments.load.allow_paths;
    if (arguments.engine != "local" && options.fresh)
      throw CLI::ValidationError("--fresh", "is only valid with --engine local");
    // The processors of this machine say nothing about those of a cluster.
    if (arguments.engine == "slurm" && options.jobs == 0) options.jobs = 1;
    choose_jobs(planned.study, options);
    require_algorithms(planned.study);
    arguments.options.wait = !arguments.no_wait;
    arguments.options.algorithms = arguments.changes.algorithms;
    experiment::StudyProgress progress{which.size()};
    // Chosen runs are executed whether the result is certain or not.
    if (!arguments.indices.empty() || !planned.study.config.until) {
      execute(arguments, planned, which, progress);
    } else {
      if (arguments.no_wait)
        throw CLI::ValidationError("--no-wait", "cannot be combined with a study that has 'until'");
      experiment::run_in_batches(planned.study, planned.runs, [&](const std::vector<std::size_t>& batch) {
        execute(arguments, planned, batch, progress);
      });
      experiment::drop_needless_seeds(planned.study, planned.runs);
      which.resize(planned.runs.size());
      std::iota(which.begin(), which.end(), std::size_t{0});
    }
    return outcome(arguments, planned, which);
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const CLI::Error*>(&error) != nullptr || dynamic_cast<const sim::ConfigError*>(&error) != nullptr)
      throw;
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

int collect(const std::string& directory, const sim::LoadOptions& load, const experiment::StudyChanges& changes,
            bool show, bool quiet) {
  experiment::catch_signals(true);
  try {
    const experiment::Manifest manifest(directory);
    experiment::PlannedStudy planned = experiment::load_planned(manifest, load, changes.algorithms);
    experiment::check_outputs(directory, planned.study.config);
    for (experiment::StudyRun& run : planned.runs) experiment::read_result(planned.study, true, run);
    if (show) experiment::show_extreme_runs(planned.study, planned.runs, directory, load.allow_paths);
    return collect_results(planned.study, planned.runs, directory, quiet);
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const sim::ConfigError*>(&error) != nullptr) throw;
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

}  // namespace

void add_study_run_command(CLI::App& study_command, int& exit_code) {
  CLI::App* command = study_command.add_subcommand("run", "Execute planned runs that have no result yet");
  const auto arguments = std::make_shared<StudyRunArguments>();
  experiment::EngineOptions& options = arguments->options;
  options.study.jobs = 0;
  options.study.threads = 0;
  // Options.
  CLI::Option* log_level = add_log_level_option(*command, "warn");
  command->add_option("DIR", arguments->directory, "folder with the manifest of `shoal study plan`")->required();
  command->add_option("--index", arguments->indices, "only these runs: 7, 1-10 or 1-3,8")
      ->type_name("RUNS")
      ->check(command_line::not_empty());
  command->add_option("--engine", arguments->engine, "local: processes of this command; parallel: GNU parallel; slurm")
      ->type_name("ENGINE")
      ->check(one_of({"local", "parallel", "slurm"}));
  add_jobs_options(*command, options.study);
  add_algorithm_option(*command, arguments->changes);
  command->add_option("--chunk", options.chunk, "runs of one job of GNU parallel or Slurm; 0: chosen by their number")
      ->type_name("N")
      ->check(whole_from(0, 100000));
  command->add_option("--ssh-login-file", options.ssh_login_file, "machines for GNU parallel, its --sshloginfile")
      ->type_name("FILE");
  command->add_option("--partition", options.partition, "of Slurm")->type_name("NAME");
  command->add_option("--time", options.time_limit, "Slurm time limit of a job, such as 30 (minutes) or 2:00:00")
      ->type_name("TIME");
  command->add_option("--sbatch", options.sbatch, "further option of sbatch, such as --sbatch=--mem=2G")
      ->type_name("OPTION")
      ->take_all();
  command->add_flag("--no-wait", arguments->no_wait, "only submit the jobs of Slurm");
  add_allow_path_option(*command, arguments->load);
  add_plugin_option(*command);
  command_line::set_help_end(
      *command, {{"shoal study run results/sweep --jobs 4", "shoal study run results/sweep --index 17",
                  "shoal study run results/sweep --engine parallel --ssh-login-file hosts.txt",
                  "shoal study run results/sweep --engine slurm --partition short --time 30"},
                 {{0, "all chosen runs have a result"},
                  {2, "wrong usage, or a mistake in the study or its world"},
                  {4, "a run failed or has no result, or a file error"},
                  {130, "ended by Ctrl-C"}},
                 {"Runs with a result are not repeated; several of these commands may work on one folder at a time."}});
  command->callback([arguments, log_level, &exit_code] {
    if (log_level->count() > 0 && !sim::log_shows(sim::LogLevel::info)) arguments->options.study.quiet = true;
    exit_code = run_planned(*arguments);
  });
}

void add_study_collect_command(CLI::App& study_command, int& exit_code) {
  CLI::App* command =
      study_command.add_subcommand("collect", "Make tables, statistics and a page of the runs of a study");
  struct Arguments {
    std::string directory;
    sim::LoadOptions load;
    experiment::StudyChanges changes;
    bool show = false, quiet = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  add_log_level_option(*command, "warn");
  command->add_option("DIR", arguments->directory, "folder with the manifest of `shoal study plan`")->required();
  command->add_flag("--show", arguments->show,
                    "rerun the runs with the largest and smallest figures, each with a 3-D page");
  command->add_flag("--quiet", arguments->quiet, "do not report the files written");
  add_algorithm_option(*command, arguments->changes);
  add_allow_path_option(*command, arguments->load);
  add_plugin_option(*command);
  command_line::set_help_end(*command, {{"shoal study collect results/sweep"},
                                        {{0, "no rule of the study failed"},
                                         {1, "a rule of the study failed"},
                                         {2, "a mistake in the study or its world"},
                                         {4, "a run has no result, or a file error"}},
                                        {}});
  command->callback([arguments, &exit_code] {
    exit_code = collect(arguments->directory, arguments->load, arguments->changes, arguments->show, arguments->quiet);
  });
}

}  // namespace tools
