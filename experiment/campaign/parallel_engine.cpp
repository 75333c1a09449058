// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "bridges/base/child_program.hpp"
#include "experiment/campaign/engines.hpp"
#include "experiment/campaign/manifest.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/files/no_links.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace fs = std::filesystem;

std::vector<std::size_t> missing_runs(const LoadedStudy& study, const EngineOptions& options,
                                      std::vector<StudyRun>& runs, const std::vector<std::size_t>& which) {
  std::vector<std::size_t> missing;
  for (const std::size_t i : which) {
    read_result(study, options.study.any_version, runs[i]);
    if (!runs[i].record) missing.push_back(i);
  }
  return missing;
}

std::vector<std::vector<std::size_t>> chunks_of(const std::vector<std::size_t>& which, std::size_t size) {
  std::vector<std::vector<std::size_t>> chunks;
  for (std::size_t begin = 0; begin < which.size(); begin += size) {
    const std::size_t end = std::min(begin + size, which.size());
    chunks.emplace_back(which.begin() + static_cast<std::ptrdiff_t>(begin),
                        which.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return chunks;
}

std::vector<std::string> chunk_command(const EngineOptions& options) {
  // The command runs on other machines and in other folders, so all paths are absolute.
  std::vector<std::string> command{own_program(), "study", "run", fs::absolute(options.study.output).string(),
                                   "--quiet"};
  if (options.study.run_timeout_s > 0) {
    command.emplace_back("--run-timeout");
    command.push_back(fmt::format("{}", options.study.run_timeout_s));
  }
  for (const std::string& algorithm : options.algorithms) {
    command.emplace_back("--algorithm");
    command.push_back(algorithm);
  }
  for (const std::string& path : options.study.allow_paths) {
    command.emplace_back("--allow-path");
    command.push_back(fs::absolute(path).string());
  }
  return command;
}

void run_by_parallel(const LoadedStudy& study, const EngineOptions& options, std::vector<StudyRun>& runs,
                     const std::vector<std::size_t>& which, StudyProgress& progress) {
  require_program("parallel", "parallel");
  if (const ProgramOutput version = output_of({"parallel", "--version"}); !version.text.starts_with("GNU parallel"))
    throw std::runtime_error(
        "the program 'parallel' in PATH is not GNU parallel; Debian has that in the package parallel");
  const std::vector<std::size_t> missing = missing_runs(study, options, runs, which);
  progress.kept += which.size() - missing.size();
  if (!options.study.quiet && missing.size() < which.size())
    std::cerr << fmt::format("{} of {} runs were already done\n", progress.kept, progress.total);
  if (missing.empty()) return;
  // Each process gets about eight chunks, so that all of them end at about the same time.
  const auto jobs = static_cast<std::size_t>(options.study.jobs);
  const std::size_t size =
      options.chunk > 0 ? options.chunk : std::clamp<std::size_t>(missing.size() / (8 * jobs), 1, 100);
  std::string lines;
  for (const auto& chunk : chunks_of(missing, size)) lines += indices_text(chunk) + "\n";
  const std::string file = options.study.output + "/parallel_chunks.txt", log = options.study.output + "/parallel.log";
  for (const std::string& path : {file, log}) {
    refuse_links(options.study.output, path);
    check_whole_file(path);
  }
  write_whole_file(file, lines);
  // Command.
  std::vector<std::string> arguments{"parallel", "--will-cite", "--jobs", fmt::format("{}", jobs), "--joblog", log};
  if (!options.ssh_login_file.empty()) {
    for (const std::string& word :
         {std::string("--sshloginfile"), options.ssh_login_file, std::string("--workdir"), fs::current_path().string()})
      arguments.push_back(word);
  }
  if (!options.study.quiet) arguments.emplace_back("--progress");
  std::string command;
  for (const std::string& word : chunk_command(options)) {
    // GNU parallel replaces {...} in the command, {= =} by the result of Perl code, whatever the quotes.
    if (word.find('{') != std::string::npos)
      throw std::runtime_error("the name '" + sim::shortened(sim::printable(word)) +
                               "' must not have a '{' with the engine parallel, which GNU parallel would replace");
    command += bridges::shell_word(word) + " ";
  }
  // The load of another machine is unknown.
  const int threads = options.ssh_login_file.empty() ? options.study.threads : 1;
  arguments.push_back(command + fmt::format("--jobs 1 --threads {} --index {{}}", threads));
  arguments.emplace_back("::::");
  arguments.push_back(file);
  run_outside_program(arguments);
  for (const std::size_t i : missing) read_result(study, options.study.any_version, runs[i]);
}

}  // namespace experiment
