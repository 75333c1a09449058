// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/study/study_config.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

struct LoadedStudy {
  StudyConfig config;
  std::vector<sim::LoadedWorld> worlds;   ///< by case
  std::vector<std::string> world_hashes;  ///< by case, of the resolved worlds; 16 hexadecimal digits
  std::vector<StudyPoint> points;         ///< of the design; one without values when there are no factors
};

/// Most runs of a study.
inline constexpr std::size_t max_study_runs = 200000;

/// Settings of the command line that replace those of the file.
struct StudyChanges {
  std::vector<std::int64_t> seeds;  ///< empty: those of the file
  std::optional<double> duration_s;
  sim::LoadOptions load;                     ///< files that its worlds may name
  bool tuned = false;                        ///< the points are not those of its design: none are made
  bool planned = false;                      ///< a manifest exists: its plan is not warned about again
  bool only_checked = false;                 ///< no run follows: plugins that the world names are not loaded
  std::vector<std::string> algorithms = {};  ///< in addition to those of the file
};

/// Reads and checks a study and its world in every case.  Throws sim::ConfigError.
LoadedStudy load_study(const std::string& path, const StudyChanges& changes = {});

/// Serial port that two concurrent runs would share.
struct SharedPort {
  sim::SourcePlace place;
  std::string who;   ///< vehicle and device
  std::string path;  ///< as the first run uses it
};
/// Finds a port whose path has no `{run}`; runs with `launch` open their serial ports.
std::optional<SharedPort> find_shared_port(const LoadedStudy& study);

}  // namespace experiment
