// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace experiment {

/// Line of a manifest: a planned run.
struct ManifestRun {
  std::size_t index = 0;  ///< from 1
  std::string in_case;
  std::size_t point = 0;  ///< from 1; 0: the study has no factors
  std::int64_t seed = 0;
  std::string inputs;  ///< see inputs_of()
};

/// Plan of a study, DIRECTORY/manifest.jsonl: a line of JSON for the study, and one for each run.
class Manifest {
 public:
  /// Reads the file and checks its first line and the number of lines.  Throws std::runtime_error with file, line and
  /// rule, like run().
  explicit Manifest(const std::string& directory);

  const std::string& directory() const { return directory_; }
  const std::string& study() const { return study_; }  ///< absolute path of its file
  const std::vector<std::int64_t>& seeds() const { return seeds_; }
  std::optional<double> duration_s() const { return duration_s_; }
  /// Algorithms in addition to those of the study.
  const std::vector<std::string>& algorithms() const { return algorithms_; }
  std::size_t size() const { return lines_.size(); }
  /// Reads the line of a run; `index` from 1 to size().
  ManifestRun run(std::size_t index) const;

 private:
  void read_head(std::string_view line);

  std::string directory_, path_, text_, study_;
  std::vector<std::int64_t> seeds_;
  std::vector<std::string> algorithms_;
  std::optional<double> duration_s_;
  std::size_t runs_ = 0;
  std::vector<std::string_view> lines_;  ///< of the runs
};

/// Name of the file in the folder of a study.
std::string manifest_path(const std::string& directory);

/// Returns the text of the manifest of a study.
std::string manifest_text(const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Writes the manifest of a study as a whole; creates the folder.  Throws std::runtime_error.
void write_manifest(const std::string& directory, const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Study of a manifest with its runs.
struct PlannedStudy {
  LoadedStudy study;
  std::vector<StudyRun> runs;
};

/// Loads the study of a manifest, with its algorithms and further ones.  Throws std::runtime_error when it has another
/// number of runs now, and sim::ConfigError.
PlannedStudy load_planned(const Manifest& manifest, const sim::LoadOptions& load,
                          const std::vector<std::string>& algorithms = {});

/// Throws std::runtime_error when one of these runs (indices into `runs`) has other inputs now than in the manifest.
void check_planned(const Manifest& manifest, const PlannedStudy& planned, const std::vector<std::size_t>& which);

/// Parses `5`, `1-100` or `3,7-9`, numbers of runs from 1 to `size`, into indices from 0 without repetitions, in
/// ascending order.  Throws std::invalid_argument with the rule.
std::vector<std::size_t> parse_indices(const std::string& text, std::size_t size);

/// Returns the text that parse_indices() parses, with ranges; `indices` from 0, in ascending order.
std::string indices_text(const std::vector<std::size_t>& indices);

}  // namespace experiment
