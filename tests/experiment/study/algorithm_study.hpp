// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "experiment/campaign/verified_runs.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/study/algorithm_table.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace algorithm_study {

inline constexpr const char* bounds = "metrics: [{name: b, type: bound, vehicle: r1, from_s: 5}]\n";

/// A study of a rover with GPS, by two algorithms; `more`: further keys, `metrics` of its world.
struct AlgorithmStudy {
  explicit AlgorithmStudy(const std::string& more = "algorithms: [ci, iu]\n", const std::string& metrics = bounds) {
    write("small.yaml", test::rover_world("        - {name: gps, type: gps, rate_hz: 1}\n", "", "", metrics));
    write("study.yaml", "shoal: 1\nstudy: tiny\nworlds: [small.yaml]\nlaunch: true\nseeds: 1-5\n" + more);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder.file(name), std::ios::binary) << text;
  }
  experiment::LoadedStudy load(const experiment::StudyChanges& changes = {}) const {
    return experiment::load_study(folder.file("study.yaml"), changes);
  }
  std::string error() const {
    try {
      load();
      return {};
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }
  test_support::ScratchFolder folder;
};

/// Runs with these rms by algorithm and seed, a bound of 1 m and a NEES by algorithm.
inline std::vector<experiment::StudyRun> runs_with(const experiment::LoadedStudy& study,
                                                   const std::map<std::string, std::vector<double>>& rms,
                                                   const std::map<std::string, std::vector<double>>& nees) {
  std::vector<experiment::StudyRun> runs = experiment::plan_study(study, "out");
  for (experiment::StudyRun& run : runs) {
    const auto seed = static_cast<std::size_t>(run.seed - 1);
    run.record.emplace();
    run.record->run_hash = "00000000000000a1";
    for (const auto& [label, values] : rms) {
      auto& metrics = run.record->metrics;
      metrics[label + ".rms_m"] = values[seed];
      metrics[label + ".ratio"] = values[seed];
      metrics[label + ".nees_mean"] = nees.at(label)[seed];
      metrics[label + ".inside_95_share"] = 0.9;
      metrics[label + ".bytes_per_h"] = 1000;
      metrics[label + ".us_per_event"] = 1 + static_cast<double>(seed);
    }
  }
  return runs;
}

}  // namespace algorithm_study
