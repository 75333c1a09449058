// SPDX-License-Identifier: BSD-3-Clause
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
#include <iostream>
#include <stdexcept>
#include <thread>

#include "bridges/base/child_program.hpp"
#include "bridges/control/other_simulators.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/run/version.hpp"
#include "experiment/study/run_files.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_runs.hpp"

namespace experiment {

namespace {

/// The first rule of a run that does not hold, and the number of others.
std::string why_failed(const RunRecord& run) {
  const auto failed = [](const RunRecord::Rule& rule) { return !rule.passed; };
  const auto first = std::find_if(run.rules.begin(), run.rules.end(), failed);
  if (first == run.rules.end()) return run.event ? "by its event '" + run.event->rule + "'" : "a program failed";
  const auto count = std::count_if(run.rules.begin(), run.rules.end(), failed);
  return first->rule + (count > 1 ? fmt::format(", and {} more", count - 1) : "");
}

using Clock = std::chrono::steady_clock;

/// Time for children to end after a signal: they end their own programs and write plots.
constexpr std::chrono::seconds timeout{20};
/// Number of attempts, because another program may use the ports.
constexpr int max_attempts = 5;
/// Time between looks at a run that another process executes.
constexpr std::chrono::milliseconds claim_interval{500};
/// Time between looks at the children.
constexpr std::chrono::milliseconds reap_interval{2};

/// Returns the LCM URL of a run's bus; each slot has its own ports, and each process its own multicast group.
std::string url_of_bus(const LoadedStudy& study, int slot, int attempt, std::size_t bus) {
  std::size_t max_buses = 0;
  for (const sim::LoadedWorld& world : study.worlds) max_buses = std::max(max_buses, world.config.buses.size());
  const auto buses = static_cast<int>(max_buses) + 1;
  const auto own = static_cast<int>(getpid());
  const int first = (own * 64 + attempt * 517) % 1500;
  const int port = 8000 + (first + slot * buses + static_cast<int>(bus)) % 2000;
  return fmt::format("udpm://239.255.{}.{}:{}?ttl=0", 77 + (own >> 8) % 150, own & 255, port);
}

/// The `shoal run` of each run, a number of them at the same time.
class StudyChildren {
 public:
  StudyChildren(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs,
                const std::vector<std::size_t>& which, StudyProgress& progress)
      : study_(study), options_(options), runs_(runs), progress_(progress) {
    for (const std::size_t i : which)
      if (options.fresh || !is_done(runs[i])) waiting_.push_back({i, 0, Clock::now()});
    const std::size_t kept = which.size() - waiting_.size();
    progress_.done += kept;
    progress_.kept += kept;
    if (kept > 0) report(fmt::format("{} of {} runs were already done", progress_.kept, progress_.total));
  }

  void run() {
    while ((!waiting_.empty() || !running_.empty()) && caught_signal() == 0) {
      while (running_.size() < static_cast<std::size_t>(options_.jobs) && start_next()) {
      }
      end_late_ones();
      if (!reap()) std::this_thread::sleep_for(running_.empty() ? claim_interval / 10 : reap_interval);
    }
    stop();
  }

  ~StudyChildren() { stop(); }

 private:
  struct Waiting {
    std::size_t run;
    int attempt;
    Clock::time_point from;  ///< not before
    bool elsewhere = false;  ///< another process executes it
  };
  struct Running {
    pid_t pid;
    Waiting what;
    int slot;
    Clock::time_point started;
    RunClaim claim;
    bool late = false;        ///< ended after the time-out
    bool algorithms = false;  ///< the run has ended: its record is being navigated
  };

  bool is_done(StudyRun& run) const {
    read_result(study_, options_.any_version, run);
    return run.record.has_value();
  }

  void report(const std::string& text) const {
    if (!options_.quiet) std::cerr << text << std::endl;
  }

  std::string name_of(const StudyRun& run) const {
    const std::string of_point = study_.config.factors.empty() ? "" : fmt::format(", point {}", run.point + 1);
    return fmt::format("{}{}, seed {}", study_.config.cases[run.in_case].name, of_point, run.seed);
  }

  int free_slot() const {
    int slot = 0;
    const auto taken = [&](const Running& running) { return running.slot == slot; };
    while (std::any_of(running_.begin(), running_.end(), taken)) ++slot;
    return slot;
  }

  /// Returns false when no run can start now.
  bool start_next() {
    const auto now = Clock::now();
    const auto ready =
        std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& each) { return each.from <= now; });
    if (ready == waiting_.end()) return false;
    Waiting what = *ready;
    waiting_.erase(ready);
    StudyRun& run = runs_[what.run];
    RunClaim claim(options_.output, run.directory);
    // Another process executes this run: its result is awaited, or the end of that process.
    if (claim.owner()) {
      if (!what.elsewhere)
        report(fmt::format("run {} ({}) is being executed by {}", run.index, name_of(run), *claim.owner()));
      what.elsewhere = true;
      what.from = now + claim_interval;
      waiting_.push_back(what);
      return true;
    }
    // The run has finished since this process looked.
    if (!options_.fresh && is_done(run)) {
      ++progress_.done;
      return true;
    }
    run.record.reset();
    remove_marks(run);
    const std::string log = run.directory + "/run.log";
    refuse_links(run.directory, log);
    const int slot = free_slot();
    std::vector<std::string> arguments =
        arguments_of(study_, run, run.directory, options_.allow_paths, options_.threads, slot, what.attempt);
    if (!study_.config.algorithms.empty()) {
      arguments.emplace_back("--record");
      arguments.push_back(record_of(run));
    }
    const pid_t pid = spawn("/proc/self/exe", arguments, log);
    running_.push_back({pid, what, slot, Clock::now(), std::move(claim)});
    return true;
  }

  // The child has its own process group: Ctrl-C is forwarded to it.
  static pid_t spawn(const std::string& program, const std::vector<std::string>& arguments, const std::string& log) {
    pid_t pid = 0;
    const int error = bridges::start_child({program, arguments, bridges::own_environment(), log}, pid);
    if (error != 0)
      throw std::runtime_error("cannot start " + arguments.front() + " for a run: " + std::strerror(error));
    return pid;
  }

  /// Starts the algorithms on the record of a run that has ended.
  void start_algorithms(Running ended) {
    const StudyRun& run = runs_[ended.what.run];
    const std::string log = run.directory + "/algorithms.log";
    refuse_links(run.directory, log);
    ended.pid = spawn(algorithm_program(), arguments_of_algorithms(study_, run), log);
    ended.algorithms = true;
    running_.push_back(std::move(ended));
  }
  /// Returns what went wrong with the algorithms; empty: nothing.
  static std::string algorithms_failure(int status) {
    return WIFEXITED(status) && WEXITSTATUS(status) == 0
               ? ""
               : fmt::format("shoal-nav could not navigate its record (exit code {}); see algorithms.log",
                             WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
  }

  void end_late_ones() {
    if (options_.run_timeout_s <= 0) return;
    for (Running& running : running_) {
      const double wall_s = std::chrono::duration<double>(Clock::now() - running.started).count();
      if (wall_s > options_.run_timeout_s && !running.late) {
        running.late = true;
        kill(running.pid, SIGTERM);
      }
      if (wall_s > options_.run_timeout_s + std::chrono::duration<double>(timeout).count()) kill(running.pid, SIGKILL);
    }
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
      Running ended = std::move(running_[i]);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      any = true;
      if (caught_signal() == 0) finish(std::move(ended), status);
    }
    return any;
  }

  void finish(Running ended, int status) {
    StudyRun& run = runs_[ended.what.run];
    std::string failure;
    if (ended.algorithms) {
      failure = algorithms_failure(status);
      std::error_code ignored;
      std::filesystem::remove(record_of(run), ignored);
    } else if (!study_.config.algorithms.empty() && WIFEXITED(status) && !ended.late) {
      read_summary(run);
      if (run.record) return start_algorithms(std::move(ended));
    }
    read_ended_run(study_, run);
    if (!failure.empty()) {
      run.record.reset();
      run.failure = failure;
    }
    // Result, or the signal that killed the run.
    if (WIFSIGNALED(status)) {
      run.record.reset();
      run.failure = fmt::format("was killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    }
    if (ended.late) {
      run.record.reset();
      run.failure = fmt::format("took longer than {:g} s", options_.run_timeout_s);
    }
    // Repeat a run whose bus was occupied.
    const bool taken = run.failure.find(bridges::another_simulator) != std::string::npos;
    if (!run.record && taken && ended.what.attempt + 1 < max_attempts)
      return waiting_.push_front({ended.what.run, ended.what.attempt + 1, Clock::now()});
    ++progress_.done;
    // Report the outcome.
    std::string outcome = "no result: " + run.failure + "; see " + run.directory + "/run.log";
    if (run.record) {
      write_stamp(run.directory, {inputs_of(study_, run), short_version()});
      const Judgement judgement = run.record->judgement;
      outcome = judgement_word(judgement);
      if (judgement == Judgement::failed) outcome += ": " + why_failed(*run.record);
    } else {
      run.tried = true;
      write_failure(run.directory, {inputs_of(study_, run), run.failure});
    }
    const double wall_s = std::chrono::duration<double>(Clock::now() - ended.started).count();
    report(fmt::format("[{}/{}] {}: {} ({:.1f} s)", progress_.done, progress_.total, name_of(run), outcome, wall_s));
  }

  void stop() {
    for (const Running& running : running_) kill(running.pid, SIGTERM);
    const auto deadline = Clock::now() + timeout;
    while (!running_.empty() && Clock::now() < deadline)
      if (!reap()) std::this_thread::sleep_for(reap_interval);
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
  StudyProgress& progress_;
};

}  // namespace

std::vector<std::string> arguments_of(const LoadedStudy& study, const StudyRun& run, const std::string& results,
                                      const std::vector<std::string>& allow_paths, int threads, int slot, int attempt) {
  const StudyConfig& config = study.config;
  std::vector<std::string> arguments{"shoal",
                                     "run",
                                     config.cases[run.in_case].world,
                                     "--seed",
                                     std::to_string(run.seed),
                                     "--results",
                                     results,
                                     "--quiet",
                                     "--no-plots",
                                     "--threads",
                                     std::to_string(threads),
                                     "--log-level",
                                     "warn",
                                     "--speed",
                                     "max"};
  const auto add = [&](const std::string& option, const std::string& value) {
    arguments.push_back(option);
    arguments.push_back(value);
  };
  // Settings of the case and the point.
  for (const std::string& set : sets_of(study, run)) add("--set", set);
  for (const std::string& path : allow_paths) add("--allow-path", path);
  if (config.duration_s) add("--duration", fmt::format("{}", *config.duration_s));
  // A run without programs uses no bus.
  if (!config.launch) {
    add("--bus", "none");
    arguments.emplace_back("--no-serial-ports");  // they are not used, and two runs cannot share one
    return arguments;
  }
  // Each concurrent run has its own buses.
  arguments.emplace_back("--launch");
  const std::string of_point = config.factors.empty() ? "" : fmt::format("-point_{}", run.point + 1);
  add("--run-name", fmt::format("{}{}-seed_{}", config.cases[run.in_case].name, of_point, run.seed));
  add("--lcm-url", url_of_bus(study, slot, attempt, 0));
  const auto& buses = study.worlds[run.in_case].config.buses;
  for (std::size_t i = 0; i < buses.size(); ++i)
    add("--set", "buses." + buses[i].name + ".lcm_url=" + url_of_bus(study, slot, attempt, i + 1));
  return arguments;
}

void run_study(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs,
               const std::vector<std::size_t>& which, StudyProgress& progress) {
  StudyChildren(study, options, runs, which, progress).run();
}

}  // namespace experiment
