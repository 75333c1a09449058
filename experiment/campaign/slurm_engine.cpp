// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "bridges/base/child_program.hpp"
#include "experiment/campaign/engines.hpp"
#include "experiment/campaign/manifest.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/process/signals.hpp"
#include "sim/config/message_text.hpp"
#include "sim/random/random.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds max_poll{5};
/// Default number of array tasks, of which a run of a few seconds makes tasks of about a minute.
constexpr std::size_t usual_tasks = 500;

[[noreturn]] void refused(const std::string& program, const ProgramOutput& output) {
  std::string text = output.text;
  std::replace(text.begin(), text.end(), '\n', ' ');
  throw std::runtime_error(
      fmt::format("{} ended with code {}: {}", program, output.exit_code, sim::shortened(sim::printable(text), 300)));
}

/// Greatest number of tasks in one array: their numbers are below MaxArraySize.
std::size_t max_tasks() {
  const ProgramOutput config = output_of({"scontrol", "show", "config"});
  if (config.exit_code != 0) refused("scontrol", config);
  const std::string key = "MaxArraySize";
  const std::size_t at = config.text.find(key);
  const std::size_t digits = config.text.find_first_of("0123456789", at == std::string::npos ? at : at + key.size());
  std::size_t size = 0;
  if (at != std::string::npos && digits != std::string::npos)
    std::from_chars(config.text.data() + digits, config.text.data() + config.text.size(), size);
  if (size < 2) throw std::runtime_error("Slurm permits no job arrays: its MaxArraySize is less than 2");
  return size - 1;
}

/// Number of tasks of the study that are queued or run for this user: another one may have jobs of the same name.
std::size_t queued_tasks(const std::string& name) {
  const ProgramOutput queue = output_of({"squeue", "--me", "--noheader", "--array", "--format=%i", "--name=" + name});
  if (queue.exit_code != 0) refused("squeue", queue);
  return static_cast<std::size_t>(std::count(queue.text.begin(), queue.text.end(), '\n'));
}

/// Submission of chunks as job arrays.
class SlurmSubmission {
 public:
  SlurmSubmission(const EngineOptions& options, std::string name)
      : options_(options), name_(std::move(name)), folder_(fs::absolute(options.study.output).string() + "/slurm") {
    const std::string root = fs::absolute(options.study.output).string();
    if (folder_.find('\\') != std::string::npos)
      throw std::runtime_error("the name '" + sim::shortened(sim::printable(folder_)) +
                               "' must not have a '\\' with the engine slurm: Slurm would not number the logs");
    make_folders(root, folder_);
    // Slurm appends to logs whose names are numbers of jobs.
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) refuse_links(root, entry.path().string());
  }

  void submit(const std::vector<std::size_t>& missing) {
    const std::size_t limit = max_tasks();
    const std::size_t size = options_.chunk > 0 ? options_.chunk : (missing.size() + usual_tasks - 1) / usual_tasks;
    const auto chunks = chunks_of(missing, size);
    for (std::size_t begin = 0; begin < chunks.size() && caught_signal() == 0; begin += limit)
      submit_array({chunks.begin() + static_cast<std::ptrdiff_t>(begin),
                    chunks.begin() + static_cast<std::ptrdiff_t>(std::min(begin + limit, chunks.size()))});
  }

 private:
  /// Names of files that do not exist yet.
  std::string next_name() const {
    std::size_t number = 1;
    std::error_code error;
    while (fs::exists(fmt::format("{}/{}.sh", folder_, number), error)) ++number;
    return fmt::format("{}/{}", folder_, number);
  }

  void submit_array(const std::vector<std::vector<std::size_t>>& chunks) {
    const std::string begin = next_name();
    std::string lines;
    for (const auto& chunk : chunks) lines += indices_text(chunk) + "\n";
    write_whole_file(begin + ".txt", lines);
    std::string command;
    for (const std::string& word : chunk_command(options_)) command += bridges::shell_word(word) + " ";
    write_whole_file(
        begin + ".sh",
        "#!/bin/sh\n# A task of `shoal study run --engine slurm`: the runs in one line of the list.\nexec " + command +
            fmt::format("--jobs {} --threads 1 --index \"$(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {})\"\n",
                        options_.study.jobs, bridges::shell_word(begin + ".txt")));
    // A task that lost its node starts again (--requeue) and continues its log; runs that have a result are skipped.
    std::vector<std::string> arguments{"sbatch",
                                       "--parsable",
                                       "--job-name=" + name_,
                                       fmt::format("--array=1-{}", chunks.size()),
                                       "--requeue",
                                       "--open-mode=append",
                                       "--output=" + slurm_pattern(folder_) + "/%A_%a.log",
                                       "--chdir=" + fs::current_path().string(),
                                       "--nodes=1",
                                       "--ntasks=1",
                                       fmt::format("--cpus-per-task={}", options_.study.jobs)};
    if (!options_.partition.empty()) arguments.push_back("--partition=" + options_.partition);
    if (!options_.time_limit.empty()) arguments.push_back("--time=" + options_.time_limit);
    arguments.insert(arguments.end(), options_.sbatch.begin(), options_.sbatch.end());
    arguments.push_back(begin + ".sh");
    const ProgramOutput output = output_of(arguments);
    if (output.exit_code != 0) refused("sbatch", output);
    if (!options_.study.quiet) {
      std::size_t count = 0;
      for (const auto& chunk : chunks) count += chunk.size();
      std::cerr << fmt::format("submitted job {}: {} runs in {} tasks\n",
                               output.text.substr(0, output.text.find_first_of(";\n")), count, chunks.size());
    }
  }

  const EngineOptions& options_;
  std::string name_, folder_;
};

/// Waits until no task is left.  Returns false after a signal.
bool await_queue(const std::string& name, bool quiet) {
  std::chrono::milliseconds pause{200};
  std::size_t shown = 0;
  while (true) {
    const std::size_t left = queued_tasks(name);
    if (left == 0) return true;
    if (!quiet && left != shown) std::cerr << fmt::format("{} tasks are queued or running\n", left);
    shown = left;
    for (auto waited = std::chrono::milliseconds{0}; waited < pause; waited += std::chrono::milliseconds{50}) {
      if (caught_signal() != 0) {
        std::cerr << fmt::format("the jobs stay in the queue; `scancel --me --name={}` removes them\n", name);
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    pause = std::min<std::chrono::milliseconds>(pause * 3 / 2, max_poll);
  }
}

}  // namespace

std::string slurm_pattern(const std::string& path) {
  std::string pattern;
  for (const char c : path) pattern += c == '%' ? std::string("%%") : std::string(1, c);
  return pattern;
}

std::string slurm_job_name(const std::string& directory) {
  const std::string path = fs::absolute(directory).lexically_normal().string();
  return fmt::format("shoal-{:08x}", static_cast<std::uint32_t>(sim::hash_text(path)));
}

void run_by_slurm(const LoadedStudy& study, const EngineOptions& options, std::vector<StudyRun>& runs,
                  const std::vector<std::size_t>& which, StudyProgress& progress) {
  for (const char* program : {"sbatch", "squeue", "scontrol"}) require_program(program, "slurm-client");
  const std::string name = slurm_job_name(options.study.output);
  if (queued_tasks(name) > 0) {
    if (!options.study.quiet) std::cerr << "jobs of an earlier call are still in the queue\n";
    if (!options.wait || !await_queue(name, options.study.quiet)) return;
  }
  std::vector<std::size_t> missing = missing_runs(study, options, runs, which);
  progress.kept += which.size() - missing.size();
  if (!options.study.quiet && missing.size() < which.size())
    std::cerr << fmt::format("{} of {} runs were already done\n", progress.kept, progress.total);
  SlurmSubmission submission(options, name);
  while (!missing.empty() && caught_signal() == 0) {
    submission.submit(missing);
    if (!options.wait || !await_queue(name, options.study.quiet)) return;
    // Failed runs would fail again; those that Slurm lost are submitted again as long as there is progress.
    std::vector<std::size_t> lost;
    for (const std::size_t i : missing_runs(study, options, runs, missing))
      if (!runs[i].tried) lost.push_back(i);
    if (lost.size() == missing.size()) {
      std::cerr << fmt::format("none of {} runs was executed; see the logs in {}/slurm\n", lost.size(),
                               options.study.output);
      return;
    }
    if (!lost.empty() && !options.study.quiet)
      std::cerr << fmt::format("{} runs have no result yet: they are submitted again\n", lost.size());
    missing = std::move(lost);
  }
}

}  // namespace experiment
