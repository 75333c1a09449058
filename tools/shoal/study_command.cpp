#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "tools/experiment/runner.hpp"
#include "tools/experiment/study_results.hpp"
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

int study(const std::string& path, StudyOptions options) {
  const LoadedStudy loaded = load_study(path);
  if (options.output.empty()) options.output = "results/" + loaded.config.name;
  choose_jobs(loaded, options);
  catch_signals(true);
  try {
    std::vector<StudyRun> runs = plan_study(loaded, options.output);
    run_study(loaded, options, runs);
    const StudyResults results(loaded, runs);
    int exit_code = results.judgement() == Judgement::failed ? exit_failed : exit_ok;
    if (results.failed_runs() > 0) exit_code = exit_bus;
    if (caught_signal() != 0) {
      std::cerr << "shoal: stopped; the same command goes on with the runs that are missing\n";
      return 128 + caught_signal();
    }
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
    std::string path;
    StudyOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  arguments->options.jobs = 0;
  command->add_option("STUDY", arguments->path, "study file, see docs/scores.md")->required();
  command->add_option("--jobs", arguments->options.jobs, "runs at the same time; 0: one for every two processors")
      ->check(CLI::Range(0, 64));
  command->add_option("--output", arguments->options.output, "folder; unset: results/NAME-OF-STUDY");
  command->add_flag("--fresh", arguments->options.fresh, "do runs again that are done already");
  command->add_flag("--quiet", arguments->options.quiet, "no progress");
  add_plugin_option(*command);
  command->footer(
      "Examples:\n  shoal study worlds/studies/coop_land.yaml --jobs 2\n"
      "  shoal report results/coop_land\n"
      "The exit code is 1 when a rule of the study fails, and 4 when a run has no result.  After Ctrl-C the same\n"
      "command goes on with the runs that are missing.");
  command->callback([arguments, &exit_code] {
    spdlog::set_level(spdlog::level::warn);
    exit_code = study(arguments->path, arguments->options);
  });
}

}  // namespace tools
