// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>
#include <stdexcept>

#include "tools/experiment/campaign/manifest.hpp"
#include "tools/experiment/process/signals.hpp"
#include "tools/experiment/study/study_results.hpp"
#include "tools/experiment/world_files/world_by_name.hpp"
#include "tools/shoal/study/study_commands.hpp"
#include "tools/shoal/study/study_parts.hpp"

namespace tools {

namespace {

int study(const std::string& path, const StudyChanges& changes, StudyOptions options) {
  LoadedStudy loaded = load_study(file_by_name({ShippedKind::study}, path), changes);
  if (options.output.empty()) options.output = usual_output(loaded, changes);
  options.allow_paths = changes.load.allow_paths;
  choose_jobs(loaded, options);
  catch_signals(true);
  try {
    std::vector<StudyRun> runs = plan_study(loaded, options.output);
    write_manifest(options.output, loaded, runs);
    check_outputs(options.output, loaded.config);
    StudyProgress progress{runs.size()};
    run_in_batches(loaded, runs,
                   [&](const std::vector<std::size_t>& which) { run_study(loaded, options, runs, which, progress); });
    if (caught_signal() != 0) {
      std::cerr << "shoal: stopped; the same command continues with the missing runs\n";
      return 128 + caught_signal();
    }
    return collect_results(loaded, runs, options.output, options.quiet);
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

int plan(const std::string& path, const StudyChanges& changes, std::string output) {
  const LoadedStudy loaded = load_study(file_by_name({ShippedKind::study}, path), changes);
  if (output.empty()) output = usual_output(loaded, changes);
  try {
    const std::vector<StudyRun> runs = plan_study(loaded, output);
    write_manifest(output, loaded, runs);
    std::cout << fmt::format("{}: {} runs: {} cases, {} points, {} seeds\n", manifest_path(output), runs.size(),
                             loaded.config.cases.size(), loaded.points.size(), loaded.config.seeds.size());
    return exit_ok;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

/// Adds the options that change what a study file says.
void add_change_options(CLI::App& command, std::string& seeds, StudyChanges& changes, std::string& output) {
  command.add_option("--seeds", seeds, "instead of those of the study: 7, 1-10 or 1-3,8")->type_name("SEEDS");
  command.add_option("--duration", changes.duration_s, "simulated seconds of each run, for a first look")
      ->type_name("S")
      ->check(number_from(1e-6, 1e9));
  command
      .add_option("--output", output,
                  "directory; without it results/NAME-OF-STUDY, with --duration 10 results/NAME-OF-STUDY_10s")
      ->type_name("DIR");
}

void take_seeds(const std::string& seeds, StudyChanges& changes) {
  try {
    if (!seeds.empty()) changes.seeds = parse_seeds(seeds);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--seeds", error.what());
  }
}

void add_study_plan_command(CLI::App& study_command, int& exit_code) {
  CLI::App* command = study_command.add_subcommand("plan", "Write the list of runs of a study, and run none");
  struct Arguments {
    std::string path, seeds, output;
    StudyChanges changes;
  };
  const auto arguments = std::make_shared<Arguments>();
  add_log_level_option(*command, "warn");
  command->add_option("STUDY", arguments->path, "study file, see docs/guides/campaigns.md")->required();
  add_change_options(*command, arguments->seeds, arguments->changes, arguments->output);
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

void add_study_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("study", "Run a world with many seeds and settings, and compare");
  struct Arguments {
    std::string path, seeds;
    StudyChanges changes;
    StudyOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  arguments->options.jobs = 0;
  // Options.
  CLI::Option* log_level = add_log_level_option(*command, "warn");
  CLI::Option* path = command->add_option("STUDY", arguments->path, "study file, see docs/guides/scoring.md");
  add_change_options(*command, arguments->seeds, arguments->changes, arguments->options.output);
  add_jobs_options(*command, arguments->options);
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
                               "shoal study run results/sweep --engine slurm", "shoal study collect results/sweep"},
                              {{0, "no rule of the study failed"},
                               {1, "a rule of the study failed"},
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
    if (log_level->count() > 0 && !spdlog::should_log(spdlog::level::info)) arguments->options.quiet = true;
    take_seeds(arguments->seeds, arguments->changes);
    exit_code = study(arguments->path, arguments->changes, arguments->options);
  });
}

}  // namespace tools
