// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/helper_programs.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace experiment {

namespace {

constexpr HelperProgram helpers[] = {
    {"ip", "iproute2", "the commands that correct the network"},
    {"gnuplot", "gnuplot-nox", "plots of --results and shoal report"},
    {"ffmpeg", "ffmpeg", "films as .mp4 and .webm"},
    {"python3", "python3", "programs in Python"},
    {"parallel", "parallel", "shoal study --engine parallel"},
    {"sbatch", "slurm-client", "shoal study --engine slurm"},
};

/// Returns the words of a value such as ID_LIKE="ubuntu debian".
std::vector<std::string> words_of(const std::string& os_release, const std::string& key) {
  std::istringstream lines(os_release);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key + "=")) continue;
    std::string value = line.substr(key.size() + 1);
    std::erase_if(value, [](char c) { return c == '"' || c == '\''; });
    std::istringstream words(value);
    return {std::istream_iterator<std::string>(words), {}};
  }
  return {};
}

bool has_apt(const std::string& os_release) {
  for (const char* key : {"ID", "ID_LIKE"}) {
    const std::vector<std::string> words = words_of(os_release, key);
    if (std::find(words.begin(), words.end(), "debian") != words.end()) return true;
  }
  return false;
}

}  // namespace

std::vector<HelperProgram> missing_helpers(const std::function<bool(const std::string&)>& has) {
  std::vector<HelperProgram> missing;
  for (const HelperProgram& helper : helpers)
    if (!has(helper.name)) missing.push_back(helper);
  return missing;
}

std::string install_command(const std::vector<HelperProgram>& programs, const std::string& os_release) {
  const bool apt = has_apt(os_release);
  std::string command = apt ? "apt-get install" : "install by the package manager of this system:";
  for (const HelperProgram& each : programs) command += std::string(" ") + (apt ? each.package : each.name);
  return command;
}

}  // namespace experiment
