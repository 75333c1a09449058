// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_programs.hpp"

#include <algorithm>

#include "experiment/results/run_error.hpp"
#include "experiment/run/run_name.hpp"
#include "sim/base/log.hpp"

namespace experiment {

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

std::vector<RunPrograms::Exit> RunPrograms::reap(sim::Time now, const Clients& clients) {
  std::vector<Exit> exits;
  for (ProcessGroup::Exit& process : processes_.reap()) {
    Exit& exit = exits.emplace_back(Exit{std::move(process), sim::to_seconds(now)});
    if (exit.client.empty()) continue;
    const bool has_left = clients.has_left(exit.client);
    const Left left = has_left ? clients.left(exit.client) : Left{};
    if (!left.reason.empty()) {
      exit.how += "; its client '" + exit.client + "' had left: " + left.reason;
      exit.time_s = left.time_s;
    } else if (!exit.failed && !has_left) {
      exit.how += " before the last tick of client '" + exit.client + "', which did not leave";
    } else {
      continue;
    }
    exit.failed = true;
  }
  return exits;
}

void RunPrograms::check(sim::Time now, const Clients& clients) {
  if (processes_.empty()) return;
  for (const Exit& exit : reap(now, clients)) {
    const std::string text = "process '" + exit.name + "' " + exit.how;
    note(exit);
    if (exit.ends_run) throw RunError(1, "process", text + "; the run ends with it, as the world requires");
    const bool goes_on = clients.removed(exit.client);
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

void RunPrograms::note_last(sim::Time now, const Clients& clients) {
  if (processes_.empty()) return;
  for (const Exit& exit : reap(now, clients)) note(exit);
  for (const sim::ProcessConfig& process : config_.processes) {
    const auto is_noted = [&](const Summary::Process& one) { return one.name == process.name; };
    if (process.client.empty() || std::any_of(ended_.begin(), ended_.end(), is_noted)) continue;
    if (const Left left = clients.left(process.client); !left.reason.empty())
      ended_.push_back({process.name, "left: " + left.reason, left.time_s, process.on_exit != sim::OnExit::ignore});
  }
}

}  // namespace experiment
