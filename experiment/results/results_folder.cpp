// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results_folder.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "bridges/base/file_descriptor.hpp"
#include "experiment/results/run_error.hpp"

namespace experiment {

ResultsLock::ResultsLock(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  // The folder itself is locked, so no lock file can be left behind.
  folder_ = bridges::FileDescriptor(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (error || folder_.number() < 0)
    throw RunError(4, "bus",
                   "cannot write results to '" + directory + "': " + (error ? error.message() : std::strerror(errno)));
  if (const auto owner = bridges::lock_against_others(folder_.number()))
    throw RunError(4, "bus",
                   "cannot write results to '" + directory + "': " + *owner +
                       " is writing there; choose another folder with --results");
}

}  // namespace experiment
