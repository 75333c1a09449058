// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/run/run_programs.hpp"

#include <algorithm>

#include "sim/base/log.hpp"
#include "tools/experiment/results/run_error.hpp"
#include "tools/experiment/run/run_name.hpp"

namespace tools {

RunPrograms::RunPrograms(const sim::WorldConfig& config, const RunOptions& options, RunBuses& buses,
                         std::string run_key)
    : config_(config), options_(options), buses_(buses), processes_(std::move(run_key)) {}

std::vector<std::string> RunPrograms::start() {
  std::vector<std::string> awaited = options_.await;
  if (!options_.launch) {
    if (!config_.processes.empty() && !options_.quiet)
      sim::log_info("the world names {} {}; --launch starts {}", config_.processes.size(),
                    config_.processes.size() == 1 ? "process" : "processes",
                    config_.processes.size() == 1 ? "it" : "them");
    return awaited;
  }
  for (sim::ProcessConfig process : config_.processes) {
    for (std::string& argument : process.command) argument = with_run_name(argument, options_.name);
    try {
      processes_.start(process, buses_.url(process.bus), options_.results);
    } catch (const std::runtime_error& error) {
      throw RunError(4, "process", error.what());
    }
    if (!process.client.empty()) awaited.push_back(process.client);
  }
  return awaited;
}

std::vector<ProcessGroup::Exit> RunPrograms::reap(const Clients& clients) {
  std::vector<ProcessGroup::Exit> exits = processes_.reap();
  for (ProcessGroup::Exit& exit : exits) {
    if (exit.failed || exit.client.empty()) continue;
    const bool has_left = clients.has_left(exit.client);
    const std::string reason = has_left ? clients.reason_to_leave(exit.client) : "";
    if (has_left && reason.empty()) continue;
    exit.failed = true;
    exit.how += has_left ? "; its client '" + exit.client + "' had left: " + reason
                         : " before the last tick of client '" + exit.client + "', which did not leave";
  }
  return exits;
}

void RunPrograms::check(sim::Time now, const Clients& clients) {
  if (processes_.empty()) return;
  for (const ProcessGroup::Exit& exit : reap(clients)) {
    const std::string text = "process '" + exit.name + "' " + exit.how;
    note(exit, now);
    if (exit.ends_run) throw RunError(1, "process", text + "; the run ends with it, as the world requires");
    const bool goes_on = clients.removed(exit.client);
    if (exit.failed && !exit.ignored)
      sim::log_error("{}; {}", text, goes_on ? "the run continues without it, and fails" : "its `on_timeout` applies");
    else
      sim::log_info("{}", text);
    removed_.insert(exit.client);
  }
}

void RunPrograms::note(const ProcessGroup::Exit& exit, sim::Time now) {
  ended_.push_back({exit.name, exit.how, sim::to_seconds(now), exit.failed && !exit.ignored});
}

void RunPrograms::note_last(sim::Time now, const Clients& clients) {
  if (processes_.empty()) return;
  for (const ProcessGroup::Exit& exit : reap(clients)) note(exit, now);
  for (const sim::ProcessConfig& process : config_.processes) {
    const auto is_noted = [&](const Summary::Process& one) { return one.name == process.name; };
    if (process.client.empty() || std::any_of(ended_.begin(), ended_.end(), is_noted)) continue;
    if (const std::string reason = clients.reason_to_leave(process.client); !reason.empty())
      ended_.push_back({process.name, "left: " + reason, sim::to_seconds(now), process.on_exit != sim::OnExit::ignore});
  }
}

}  // namespace tools
