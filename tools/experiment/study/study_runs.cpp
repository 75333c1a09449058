// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/study/study_runs.hpp"

#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "bridges/control/other_simulators.hpp"
#include "tools/experiment/process/child_program.hpp"
#include "tools/experiment/run/runner.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Time for children to end after a signal: they end their own programs and write plots.
constexpr std::chrono::seconds timeout{20};
/// Number of attempts, because another program may use the ports.
constexpr int max_attempts = 3;

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

/// Returns what a run depends on; a kept run must have the same.
std::string stamp_of(const LoadedStudy& study, const StudyRun& run) {
  const std::string world = sim::to_yaml(study.worlds[run.in_case].resolved);
  const StudyConfig& config = study.config;
  return fmt::format("world {:016x} seed {} duration {} launch {} shoal {}\n", fnv1a(world), run.seed,
                     config.duration_s ? fmt::format("{}", *config.duration_s) : "as the world says",
                     config.launch ? "yes" : "no", short_version());
}

std::string stamp_file(const StudyRun& run) {
  return run.directory + "/study_stamp.txt";
}

/// Reads the results of a run.  Unset, with the reason: they do not exist, or the run did not reach its end.
void read_record(StudyRun& run) {
  run.record.reset();
  try {
    RunRecord record = read_run(run.directory);
    const bool done = record.exit_code == 0 || record.exit_code == 1;
    const bool by_hand = record.ended == "quit" || record.ended == "signal";
    if (done && !by_hand && record.ended != "process")
      run.record = std::move(record);
    else if (!record.error.empty())
      run.failure = record.error;
    else
      run.failure = by_hand ? record.not_judged : fmt::format("exit code {}", record.exit_code);
  } catch (const std::runtime_error& error) {
    run.failure = error.what();
  }
}

class StudyChildren {
 public:
  StudyChildren(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs)
      : study_(study), options_(options), runs_(runs) {
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (options.fresh || !is_done(runs[i])) waiting_.push_back({i, 0});
    done_ = runs.size() - waiting_.size();
    if (done_ > 0) report(fmt::format("{} of {} runs were already done", done_, runs.size()));
  }

  void run() {
    while ((!waiting_.empty() || !running_.empty()) && caught_signal() == 0) {
      while (!waiting_.empty() && running_.size() < static_cast<std::size_t>(options_.jobs)) start_next();
      if (!reap()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    stop();
  }

  ~StudyChildren() { stop(); }

 private:
  struct Waiting {
    std::size_t run;
    int attempt;
  };
  struct Running {
    pid_t pid;
    Waiting what;
    int slot;
    Clock::time_point started;
  };

  static bool is_same(const std::string& path, const std::string& text) {
    std::error_code error;
    if (!fs::exists(path, error)) return false;
    return read_whole_file(path) == text;
  }

  bool is_done(StudyRun& run) {
    if (!is_same(stamp_file(run), stamp_of(study_, run))) return false;
    read_record(run);
    return run.record.has_value();
  }

  void report(const std::string& text) const {
    if (!options_.quiet) std::cerr << text << std::endl;
  }

  int free_slot() const {
    int slot = 0;
    const auto taken = [&](const Running& running) { return running.slot == slot; };
    while (std::any_of(running_.begin(), running_.end(), taken)) ++slot;
    return slot;
  }

  /// Returns the LCM URL of a run's bus; each slot has its own ports.
  std::string url(int slot, int attempt, std::size_t bus) const {
    const auto buses = static_cast<int>(study_.worlds[0].config.buses.size()) + 1;
    const int first = (static_cast<int>(getpid()) * 64 + attempt * 517) % 1500;
    const int port = 8000 + (first + slot * buses + static_cast<int>(bus)) % 2000;
    return fmt::format("udpm://239.255.76.67:{}?ttl=0", port);
  }

  std::vector<std::string> arguments_of(const StudyRun& run, int slot, int attempt) const {
    const StudyConfig& config = study_.config;
    std::vector<std::string> arguments{"shoal",     "run",         config.world, "--seed",     std::to_string(run.seed),
                                       "--results", run.directory, "--quiet",    "--no-plots", "--threads",
                                       "1",         "--log-level", "warn",       "--speed",    "max"};
    const auto add = [&](const std::string& option, const std::string& value) {
      arguments.push_back(option);
      arguments.push_back(value);
    };
    // Settings of the case.
    for (const std::string& set : config.cases[run.in_case].sets()) add("--set", set);
    for (const std::string& path : options_.allow_paths) add("--allow-path", path);
    if (config.duration_s) add("--duration", fmt::format("{}", *config.duration_s));
    // Without programs no bus is used.
    if (!config.launch) {
      add("--bus", "none");
      arguments.emplace_back("--no-serial-ports");  // they are not used, and two runs cannot share one
      return arguments;
    }
    // Each concurrent run has its own buses.
    arguments.emplace_back("--launch");
    add("--run-name", fmt::format("{}-seed_{}", config.cases[run.in_case].name, run.seed));
    add("--lcm-url", url(slot, attempt, 0));
    const auto& buses = study_.worlds[run.in_case].config.buses;
    for (std::size_t i = 0; i < buses.size(); ++i)
      add("--set", "buses." + buses[i].name + ".lcm_url=" + url(slot, attempt, i + 1));
    return arguments;
  }

  void start_next() {
    const Waiting what = waiting_.front();
    waiting_.pop_front();
    StudyRun& run = runs_[what.run];
    run.record.reset();
    std::error_code error;
    fs::create_directories(run.directory, error);
    if (error) throw std::runtime_error(run.directory + ": cannot be made: " + error.message());
    fs::remove(stamp_file(run), error);
    fs::remove(run.directory + "/summary.json", error);
    const int slot = free_slot();
    running_.push_back(
        {spawn(arguments_of(run, slot, what.attempt), run.directory + "/run.log"), what, slot, Clock::now()});
  }

  // In its own process group: Ctrl-C is forwarded to it.
  static pid_t spawn(const std::vector<std::string>& arguments, const std::string& log) {
    pid_t pid = 0;
    const int error = start_child({"/proc/self/exe", arguments, own_environment(), log}, pid);
    if (error != 0) throw std::runtime_error(std::string("cannot start a run: ") + std::strerror(error));
    return pid;
  }

  /// Returns true when at least one ended.
  bool reap() {
    bool any = false;
    for (std::size_t i = 0; i < running_.size();) {
      int status = 0;
      if (waitpid(running_[i].pid, &status, WNOHANG) != running_[i].pid) {
        ++i;
        continue;
      }
      const Running ended = running_[i];
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      any = true;
      if (caught_signal() == 0) finish(ended, status);
    }
    return any;
  }

  void finish(const Running& ended, int status) {
    StudyRun& run = runs_[ended.what.run];
    read_record(run);
    // Result, or the signal that killed the run.
    if (WIFSIGNALED(status)) {
      run.record.reset();
      run.failure = fmt::format("was killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    }
    // Repeat a run whose bus was occupied.
    const bool taken = run.failure.find(bridges::another_simulator) != std::string::npos;
    if (!run.record && taken && ended.what.attempt + 1 < max_attempts)
      return waiting_.push_front({ended.what.run, ended.what.attempt + 1});
    ++done_;
    // Report the outcome.
    std::string outcome = "failed: " + run.failure + "; see " + run.directory + "/run.log";
    if (run.record) {
      std::ofstream(stamp_file(run), std::ios::binary) << stamp_of(study_, run);
      const Judgement judgement = run.record->judgement;
      outcome = judgement == Judgement::failed   ? "done, its rules failed"
                : judgement == Judgement::passed ? "passed"
                                                 : "done, not judged";
    }
    const double wall_s = std::chrono::duration<double>(Clock::now() - ended.started).count();
    report(fmt::format("[{}/{}] {}, seed {}: {} ({:.1f} s)", done_, runs_.size(), study_.config.cases[run.in_case].name,
                       run.seed, outcome, wall_s));
  }

  void stop() {
    for (const Running& running : running_) kill(running.pid, SIGTERM);
    const auto deadline = Clock::now() + timeout;
    while (!running_.empty() && Clock::now() < deadline)
      if (!reap()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (const Running& running : running_) {
      kill(running.pid, SIGKILL);
      while (waitpid(running.pid, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
    running_.clear();
  }

  const LoadedStudy& study_;
  const StudyOptions& options_;
  std::vector<StudyRun>& runs_;
  std::deque<Waiting> waiting_;
  std::vector<Running> running_;
  std::size_t done_ = 0;
};

}  // namespace

std::vector<StudyRun> plan_study(const LoadedStudy& study, const std::string& output) {
  std::vector<StudyRun> runs;
  for (std::size_t i = 0; i < study.config.cases.size(); ++i)
    for (const std::int64_t seed : study.config.seeds)
      runs.push_back({i, seed, fmt::format("{}/runs/{}/seed_{}", output, study.config.cases[i].name, seed), {}, ""});
  return runs;
}

void run_study(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs) {
  StudyChildren(study, options, runs).run();
}

}  // namespace tools
