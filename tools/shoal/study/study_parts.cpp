// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/study/study_parts.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iostream>
#include <thread>

#include "experiment/campaign/engines.hpp"
#include "experiment/campaign/study_database.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_results.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

std::string usual_output(const experiment::LoadedStudy& study, const experiment::StudyChanges& changes) {
  const std::string look = changes.duration_s ? fmt::format("_{:g}s", *changes.duration_s) : "";
  return "results/" + study.config.name + look;
}

void choose_jobs(const experiment::LoadedStudy& study, experiment::StudyOptions& options) {
  const auto shared = experiment::find_shared_port(study);
  if (shared && options.jobs > 1)
    sim::throw_config_error(
        shared->place, shared->who,
        "concurrent runs cannot share serial port '" + shared->path + "': put {run} into its path, or use --jobs 1");
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const bool chosen = options.jobs > 0;
  if (!chosen) options.jobs = shared ? 1 : std::max(1, processors / 2);
  if (options.threads == 0) options.threads = std::max(1, processors / options.jobs);
  if (!chosen && shared && processors > 3 && !options.quiet)
    std::cerr << "one run at a time: all have the serial port '" << shared->path
              << "'; with {run} in its path each has its own\n";
}

int collect_results(experiment::LoadedStudy& study, std::vector<experiment::StudyRun>& runs, const std::string& output,
                    bool quiet) {
  experiment::drop_needless_seeds(study, runs);
  const experiment::StudyResults results(study, runs);
  int exit_code = results.judgement() == experiment::Judgement::failed ? exit_failed : exit_ok;
  if (results.failed_runs() > 0) exit_code = exit_bus;
  experiment::write_study(output, study, runs, results, exit_code);
  experiment::write_database(output + "/study.sqlite", results);
  experiment::write_whole_file(output + "/report.html", experiment::report_page({output}));
  std::cout << results.to_text(output);
  if (!quiet) std::cerr << "results in " << output << "/ (study.csv, study.json, study.sqlite, report.html)\n";
  return experiment::caught_signal() != 0 ? 128 + experiment::caught_signal() : exit_code;
}

void add_jobs_options(CLI::App& command, experiment::StudyOptions& options) {
  command.add_option("--jobs", options.jobs, "runs at the same time; 0: one for every two processors")
      ->type_name("N")
      ->check(whole_from(0, 64));
  command
      .add_option("--threads", options.threads,
                  "threads of each run, which share the work of a step; 0: the processors shared among the runs")
      ->type_name("N")
      ->check(whole_from(0, 256));
  command
      .add_option("--run-timeout", options.run_timeout_s, "wall time after which a run is ended and counts as failed")
      ->type_name("S")
      ->check(number_from(0, 1e9));
  command.add_flag("--fresh", options.fresh, "repeat runs that are complete");
  command.add_flag("--quiet", options.quiet, "no progress");
}

void require_algorithms(const experiment::LoadedStudy& study) {
  std::string names;
  for (const std::string& algorithm : study.config.algorithms) names += (names.empty() ? "" : ",") + algorithm;
  if (names.empty()) return;
  const experiment::ProgramOutput output =
      experiment::output_of({experiment::algorithm_program(), "--list", "--algorithm", names});
  if (output.exit_code == 0) return;
  const std::string start = "shoal-nav: ";
  std::string text = output.text.starts_with(start) ? output.text.substr(start.size()) : output.text;
  text.resize(std::min(text.find("\nSee "), text.size()));
  while (text.ends_with('\n')) text.pop_back();
  sim::throw_config_error(study.config.algorithms_place, "", "'algorithms': " + text);
}

void add_algorithm_option(CLI::App& command, experiment::StudyChanges& changes) {
  command_line::add_name_list(command, "--algorithm", changes.algorithms,
                              "algorithms of shoal-nav in addition to those of the study, such as python:FILE.Class");
}

}  // namespace tools
