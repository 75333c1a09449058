// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "tools/experiment/run/runner.hpp"
#include "tools/experiment/study/study_results.hpp"
#include "tools/experiment/world_files/world_by_name.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

void choose_jobs(const LoadedStudy& study, StudyOptions& options) {
  const auto shared = find_shared_port(study);
  if (shared && options.jobs > 1)
    sim::throw_config_error(shared->place, shared->who,
                            "runs at the same time cannot have one serial port, '" + shared->path +
                                "': put {run} into its path, or use --jobs 1");
  if (options.jobs > 0) return;
  options.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency() / 2));
  if (!shared || options.jobs == 1) return;
  options.jobs = 1;
  if (!options.quiet)
    std::cerr << "one run at a time: all have the serial port '" << shared->path
              << "'; with {run} in its path each has its own\n";
}

int study(const std::string& path, const StudyChanges& changes, StudyOptions options) {
  const LoadedStudy loaded = load_study(file_by_name({ShippedKind::study}, path), changes);
  // A short trial does not overwrite the runs of the whole study.
  const std::string look = changes.duration_s ? fmt::format("_{:g}s", *changes.duration_s) : "";
  if (options.output.empty()) options.output = "results/" + loaded.config.name + look;
  options.allow_paths = changes.load.allow_paths;
  choose_jobs(loaded, options);
  catch_signals(true);
  try {
    // Run the missing runs.
    std::vector<StudyRun> runs = plan_study(loaded, options.output);
    run_study(loaded, options, runs);
    const StudyResults results(loaded, runs);
    int exit_code = results.judgement() == Judgement::failed ? exit_failed : exit_ok;
    if (results.failed_runs() > 0) exit_code = exit_bus;
    if (caught_signal() != 0) {
      std::cerr << "shoal: stopped; the same command continues with the missing runs\n";
      return 128 + caught_signal();
    }
    // Write and print the results.
    write_study(options.output, loaded, runs, results, exit_code);
    std::cout << results.to_text();
    if (!options.quiet) std::cerr << "results in " << options.output << "/ (study.csv, study.json)\n";
    return caught_signal() != 0 ? 128 + caught_signal() : exit_code;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
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
  command->add_option("STUDY", arguments->path, "study file, see docs/guides/scoring.md")->required();
  command->add_option("--seeds", arguments->seeds, "instead of those of the study: 7, 1-10 or 1-3,8")
      ->type_name("SEEDS");
  command->add_option("--duration", arguments->changes.duration_s, "simulated seconds of each run, for a first look")
      ->type_name("S")
      ->check(number_from(1e-6, 1e9));
  command->add_option("--jobs", arguments->options.jobs, "runs at the same time; 0: one for every two processors")
      ->type_name("N")
      ->check(whole_from(0, 64));
  command
      ->add_option("--output", arguments->options.output,
                   "directory; without it results/NAME-OF-STUDY, with --duration 10 results/NAME-OF-STUDY_10s")
      ->type_name("DIR");
  command->add_flag("--fresh", arguments->options.fresh, "repeat runs that are complete");
  command->add_flag("--quiet", arguments->options.quiet, "no progress");
  add_allow_path_option(*command, arguments->changes.load);
  add_plugin_option(*command);
  // End of the help and action.
  command_line::set_help_end(*command, {{"shoal study worlds/studies/coop_land.yaml --jobs 2",
                                         "shoal study worlds/studies/coop_underwater.yaml --seeds 1-2 --duration 60",
                                         "shoal report results/coop_land"},
                                        {{0, "no rule of the study failed"},
                                         {1, "a rule of the study failed"},
                                         {2, "wrong usage, or a mistake in the study or its world"},
                                         {4, "a run has no result, or a file error"},
                                         {130, "ended by Ctrl-C"}},
                                        {"After Ctrl-C the same command continues with the missing runs."}});
  command->callback([arguments, log_level, &exit_code] {
    if (log_level->count() > 0 && !spdlog::should_log(spdlog::level::info)) arguments->options.quiet = true;
    try {
      if (!arguments->seeds.empty()) arguments->changes.seeds = parse_seeds(arguments->seeds);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError("--seeds", error.what());
    }
    exit_code = study(arguments->path, arguments->changes, arguments->options);
  });
}

}  // namespace tools
