// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace study_folder {

inline void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A folder with a world of one metric `e`, and a study of it.
struct StudyFolder {
  explicit StudyFolder(const std::string& more, const std::string& seeds = "[1, 2]") {
    write(folder.file("small.yaml"),
          test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                            "metrics: [{name: e, type: position_error, vehicle: r1, channel: est}]\n"));
    write(path(), "shoal: 1\nstudy: tiny\nworld: small.yaml\nseeds: " + seeds + "\n" + more);
  }
  std::string path() const { return folder.file("study.yaml"); }
  std::string error() const {
    try {
      experiment::load_study(path());
      return {};
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }

  test_support::ScratchFolder folder;
};

inline const std::string two_cases =
    "cases:\n"
    "  - {name: plain}\n"
    "  - {name: quick, set: {physics.step_s: 0.002, name: fast}}\n";

/// Runs as if they had been done: `rms` by case, one for each seed; NaN: the figure is null.
inline std::vector<experiment::StudyRun> made_up_runs(const experiment::LoadedStudy& study,
                                                      const std::vector<std::vector<double>>& rms) {
  std::vector<experiment::StudyRun> runs = experiment::plan_study(study, "out");
  for (experiment::StudyRun& run : runs) {
    const double value = rms[run.in_case][static_cast<std::size_t>(run.seed - study.config.seeds[0])];
    run.record.emplace();
    run.record->metrics["e.rms_m"] = std::isnan(value) ? std::nullopt : std::optional<double>(value);
    run.record->judgement = experiment::judgement_of(value < 3);
    run.record->ended = "duration";
    run.record->run_hash = "00000000000000a1";
  }
  return runs;
}

}  // namespace study_folder
