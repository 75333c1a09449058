// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/shown_runs.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <iostream>
#include <set>
#include <stdexcept>

#include "experiment/campaign/engines.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/study/study_results.hpp"
#include "experiment/study/study_tables.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

/// Returns whether the folder has the results of an equal run.
bool is_equal(const std::string& folder, const StudyRun& run) {
  try {
    return read_run(folder).run_hash == run.record->run_hash;
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace

void show_extreme_runs(const LoadedStudy& study, const std::vector<StudyRun>& runs, const std::string& directory,
                       const std::vector<std::string>& allow_paths) {
  // A run may be extreme in several figures.
  std::set<std::size_t> indices;
  const StudyResults results(study, runs);
  for (const ExtremeRun& extreme : extreme_runs(results)) {
    const StudyRun& run = *extreme.run;
    const std::string folder = directory + "/" + shown_folder(run);
    std::error_code error;
    if (!indices.insert(run.index).second || caught_signal() != 0) continue;
    if (fs::exists(folder + "/run.html", error) && is_equal(folder, run)) continue;
    make_folders(directory, folder);
    for (const char* name : {"run.html", "run.lcm", "report.html"}) refuse_links(folder, folder + "/" + name);
    fs::remove(folder + "/run.html", error);
    std::vector<std::string> arguments = arguments_of(study, run, folder, allow_paths, 0, 0, 0);
    arguments.front() = own_program();
    for (const std::string& word : {std::string("--record"), folder + "/run.lcm", std::string("--overwrite")})
      arguments.push_back(word);
    output_of(arguments);
    if (!is_equal(folder, run)) {
      std::cerr << fmt::format("run {} differs when it is executed again: no page in {}\n", run.index, folder);
      continue;
    }
    const ProgramOutput page = output_of({own_program(), "report", folder});
    if (page.exit_code != 0) std::cerr << "shoal report " << folder << ": " << page.text;
    fs::remove(folder + "/run.lcm", error);
  }
}

}  // namespace experiment
