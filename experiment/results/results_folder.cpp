// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results_folder.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/results/run_plots.hpp"
#include "experiment/results/run_record.hpp"
#include "experiment/results/summary_file.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/diagnostics.hpp"

namespace experiment {

std::string cannot_write_text(const std::string& path, int error_number) {
  const bool full = error_number == ENOSPC || error_number == EDQUOT;
  const bool closed = error_number == EROFS || error_number == EACCES || error_number == EPERM;
  return "cannot write results to '" + path + "': " + std::strerror(error_number) +
         (full ? "; free some space, or choose another folder with --results" : "") +
         (closed ? "; choose another folder with --results" : "");
}

ResultsLock::ResultsLock(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  // The folder itself is locked, so no lock file can be left behind.
  folder_ = bridges::FileDescriptor(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (error || folder_.number() < 0)
    throw RunError(4, "bus", cannot_write_text(directory, error ? error.value() : errno));
  if (const auto owner = bridges::lock_against_others(folder_.number()))
    throw RunError(4, "bus",
                   "cannot write results to '" + directory + "': " + *owner +
                       " is writing there; choose another folder with --results");
}

namespace {

/// Removes a file; folders and links to devices are kept.
void remove_file(const std::string& path) {
  std::error_code error;
  remove_link(path);
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error)))
    std::filesystem::remove(path, error);
}

/// Returns the names of the programs of the world in a results folder; none when it cannot be read.
std::vector<std::string> programs_in(const std::string& world_file) {
  std::vector<std::string> names;
  try {
    sim::Diagnostics problems;
    const sim::ConfigNode world = sim::parse_config_text(read_whole_file(world_file), world_file, problems);
    for (const char* key : {"processes", "bridges"})
      if (const sim::ConfigNode* programs = world.find(key))
        for (const sim::ConfigNode& program : programs->items)
          if (const std::string* name = sim::name_of(program)) names.push_back(*name);
  } catch (const std::exception&) {  // there is none, or it cannot be read
  }
  return names;
}

}  // namespace

void remove_earlier_run(const std::string& directory) {
  std::error_code error;
  for (const std::string& program : programs_in(directory + "/world.yaml"))
    if (program.find('/') == std::string::npos) remove_file(directory + "/" + program + ".log");
  for (const char* image : run_plots) remove_file(directory + "/" + image);
  for (const char* file : {"summary.json", "metrics.csv", "errors.csv", "tracks.csv", "outlines.dat", "plot.gp",
                           "plot.log", "report.html", "run.html"})
    remove_file(directory + "/" + file);
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string branch = entry.path().string();
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("branch") || name.size() == 6 || name.find_first_not_of("0123456789", 6) != std::string::npos)
      continue;
    if (!std::filesystem::is_directory(entry.symlink_status(error))) continue;
    for (const char* file : {"summary.json", "metrics.csv", "errors.csv", "tracks.csv", "world.yaml"})
      remove_file(branch + "/" + file);
    std::filesystem::remove(branch, error);  // fails if other files are in it, which stay
  }
}

}  // namespace experiment
