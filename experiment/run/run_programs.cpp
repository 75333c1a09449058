// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_programs.hpp"

#include <algorithm>

#include "experiment/results/run_error.hpp"
#include "experiment/run/run_ports.hpp"
#include "sim/base/log.hpp"

namespace experiment {

RunPrograms::RunPrograms(const RunOptions& options, RunParts& parts, bridges::TimeMachine& time, std::string run_key)
    : options_(options), parts_(parts), time_(time), processes_(std::move(run_key)) {}

std::vector<std::string> RunPrograms::start() {
  const std::vector<sim::ProcessConfig>& all = parts_.world.config().processes;
  std::vector<std::string> awaited = options_.await;
  if (!options_.launch) {
    if (!all.empty() && !options_.quiet)
      sim::log_info("the world names {} {}; --launch starts {}", all.size(), all.size() == 1 ? "process" : "processes",
                    all.size() == 1 ? "it" : "them");
    return awaited;
  }
  for (sim::ProcessConfig process : all) {
    for (std::string& argument : process.command) argument = with_run_name(argument, options_.name);
    try {
      processes_.start(process, parts_.buses.url(process.bus), options_.results);
    } catch (const std::runtime_error& error) {
      throw RunError(4, "process", error.what());
    }
    if (!process.client.empty()) awaited.push_back(process.client);
  }
  return awaited;
}

std::vector<RunPrograms::Exit> RunPrograms::reap(bool requests_count) {
  std::vector<Exit> exits;
  for (ProcessGroup::Exit& process : processes_.reap()) {
    Exit& exit = exits.emplace_back(Exit{std::move(process), sim::to_seconds(parts_.world.now())});
    if (exit.client.empty()) continue;
    if (requests_count) parts_.service.handle_requests(&time_);  // the last request may be to leave
    const bool has_left = parts_.lockstep.has_left(exit.client);
    const std::string reason = has_left ? parts_.lockstep.reason_to_leave(exit.client) : "";
    if (!reason.empty()) {
      exit.how += "; its client '" + exit.client + "' had left: " + reason;
      exit.time_s = parts_.lockstep.end_s(exit.client);
    } else if (!exit.failed && !has_left) {
      exit.how += " before the last tick of client '" + exit.client + "', which did not leave";
    } else {
      continue;
    }
    exit.failed = true;
  }
  return exits;
}

void RunPrograms::check(const std::function<void()>& before_report) {
  if (processes_.empty()) return;
  for (const Exit& exit : reap(true)) {
    const std::string text = "process '" + exit.name + "' " + exit.how;
    note(exit);
    if (exit.ends_run) throw RunError(1, "process", text + "; the run ends with it, as the world requires");
    if (before_report) before_report();
    parts_.service.client_exited(exit.client);
    const bool goes_on = !parts_.lockstep.has(exit.client);  // otherwise its `on_timeout` applies
    if (exit.failed && !exit.ignored)
      sim::log_error("{}; {}", text, goes_on ? "the run continues without it, and fails" : "its `on_timeout` applies");
    else
      sim::log_info("{}", text);
    removed_.insert(exit.client);
  }
}

void RunPrograms::note(const Exit& exit) {
  ended_.push_back({exit.name, exit.how, exit.time_s, exit.failed && !exit.ignored});
}

void RunPrograms::note_last() {
  if (processes_.empty()) return;
  for (const Exit& exit : reap(false)) note(exit);
  for (const sim::ProcessConfig& process : parts_.world.config().processes) {
    const auto is_noted = [&](const Summary::Process& one) { return one.name == process.name; };
    if (process.client.empty() || std::any_of(ended_.begin(), ended_.end(), is_noted)) continue;
    if (const std::string reason = parts_.lockstep.reason_to_leave(process.client); !reason.empty())
      ended_.push_back({process.name, "left: " + reason, parts_.lockstep.end_s(process.client),
                        process.on_exit != sim::OnExit::ignore});
  }
}

}  // namespace experiment
