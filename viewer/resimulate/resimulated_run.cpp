// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/resimulate/resimulated_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "experiment/results/run_error.hpp"
#include "experiment/run/scores_message.hpp"
#include "experiment/score/scoring.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

namespace viewer {

namespace {

using std::chrono::microseconds;

/// Snapshots of the last ten minutes are kept; to go further back the run starts again.
constexpr double snapshots_s = 600;
constexpr microseconds paused_wait{20'000};

experiment::ReplayedWorld::Options replay_options(const ResimulatedRun::Options& options,
                                                  experiment::ReplayedWorld::Watch inputs) {
  experiment::ReplayedWorld::Options replay{"", options.load, options.threads, std::move(inputs), {}};
  if (options.launch) replay.for_programs = options.lcm_url;
  return replay;
}

}  // namespace

ResimulatedRun::ResimulatedRun(const Options& options, const std::string& version)
    : log_(experiment::read_replay_log(options.log)),
      page_(options.view, version),
      replayed_(log_, replay_options(options, page_tap()), page_tap()),
      scoring_(replayed_.world()),
      view_(
          replayed_.bus(), replayed_.world(),
          [this](shoal::sim_scores_t& message) { experiment::fill_scores(scoring_, message); }, [] { return true; }),
      control_(replayed_.parts().control),
      time_(replayed_.world(), control_, scoring_, replayed_.parts().service, {.kept_s = snapshots_s}) {
  if (options.launch) check_buses();
  if (options.launch && !replayed_.loaded().config.processes.empty())
    programs_ = std::make_unique<BranchPrograms>(
        replayed_, [this](const std::string& command, double value) { return execute(command, value, ""); });
  if (log_.snapshot)
    if (const std::string problem = experiment::restore_scores(scoring_, log_.snapshot->scores); !problem.empty())
      sim::log_warn("{}: {}", log_.path, problem);
  control_.speed = 1;
  page_.start(world(), end_s(), {"recorded", programs(), programs_ != nullptr});
  replayed_.start();
  first_ = time_.save(experiment::History::length);
  after_step();
}

/// Programs need buses of this machine without another simulator.
void ResimulatedRun::check_buses() {
  if (replayed_.parts().buses.leave_machine())
    throw experiment::RunError(2, "configuration",
                               "--launch: the buses of a record that is run again must not leave this machine");
  if (const auto other = replayed_.parts().other_simulators.look(
          [this](std::chrono::milliseconds time) { replayed_.parts().buses.wait(time); }))
    throw experiment::RunError(4, "bus", *other + "; choose another port with --lcm-url");
}

const char* ResimulatedRun::programs() const {
  if (restarted_) return "restarted programs";
  return replayed_.has_commands() ? "recorded commands" : "no programs";
}

std::vector<std::string> ResimulatedRun::commands() const {
  std::vector<std::string> commands;
  if (!programs_) return commands;
  for (const sim::ProcessConfig& process : replayed_.loaded().config.processes)
    commands.push_back(fmt::format("{}", fmt::join(process.command, " ")));
  return commands;
}

experiment::ReplayedWorld::Watch ResimulatedRun::page_tap() {
  return [this](std::string_view channel, std::span<const std::byte> payload) {
    page_.message(channel, payload, world().now());
  };
}

double ResimulatedRun::end_s() const {
  return sim::to_seconds(world().step_time()) * static_cast<double>(log_.usable_step());
}

void ResimulatedRun::go_to_start() {
  time_.load(first_, experiment::History::length);
  replayed_.repeat_inputs();
}

bool ResimulatedRun::at_end() const {
  return !branched_ && world().step_number() >= log_.usable_step();
}

void ResimulatedRun::after_step() {
  view_.after_step();
  page_.after_step(world(), view_, control_);
  if (programs_) programs_->end_of_step();
  if (!programs_ || !programs_->running()) time_.keep();  // programs have no snapshots
}

void ResimulatedRun::step() {
  const std::int64_t step = world().step_number();
  try {
    // Changes that were made on this branch before it was rewound.
    const auto [from, to] = changes_.equal_range(step);
    for (auto change = from; catch_up_ && change != to; ++change) replayed_.request(change->second);
    replayed_.step();
  } catch (const sim::PhysicsFault& error) {
    return fail(std::string("the world cannot continue: ") + error.what());
  } catch (const std::runtime_error& error) {
    page_.problem(error.what());
  }
  scoring_.after_step();
  control_.step_taken();
  after_step();
  if (catch_up_ && world().step_number() >= *catch_up_) arrive();
  time_.stop_when_there();
  if (!at_end()) return;
  control_.clear_until();
  control_.set_paused(true);
}

/// Pauses a run that cannot continue; it can be taken back.
void ResimulatedRun::fail(const std::string& why) {
  faulty_ = true;
  control_.set_paused(true);
  catch_up_.reset();
  if (programs_) programs_->stop();
  sim::log_error("{}", why);
  page_.problem(why);
}

void ResimulatedRun::serve() {
  page_.serve(world(), view_, control_, programs_ ? programs_->waits_for() : "",
              RunView::answering([this](const std::string& command, double value, const std::string& text) {
                return execute(command, value, text);
              }));
}

/// Returns whether no program is waited for.
bool ResimulatedRun::programs_are_ready() {
  try {
    return programs_->ready();
  } catch (const std::runtime_error& error) {  // RunError, LockstepTimeout
    fail(error.what());
    return false;
  }
}

microseconds ResimulatedRun::advance() {
  serve();
  if (programs_ && !programs_are_ready()) return faulty_ ? paused_wait : microseconds{0};
  if (catch_up_ && world().step_number() >= *catch_up_) arrive();
  if (catch_up_) {
    step();
    return microseconds{0};
  }
  if (!control_.may_step() || at_end() || faulty_) return paused_wait;
  const microseconds wait =
      control_.paused ? microseconds{0} : pacer_.until(world().now() + world().step_time(), control_);
  if (wait > microseconds{0}) return std::min(wait, paused_wait);
  step();
  return microseconds{0};
}

void ResimulatedRun::run(const std::function<bool()>& goes_on) {
  while (goes_on())
    if (const microseconds wait = advance(); wait > microseconds{0}) std::this_thread::sleep_for(wait);
}

std::string ResimulatedRun::place() const {
  return time_.place() + (branched_ ? fmt::format(", branch {}", control_.branch) : ", record");
}

std::string ResimulatedRun::execute(const std::string& command, double value, const std::string& text) {
  if (command == "branch") return branch(text);
  if (command == "rewind") return rewind(value);
  if (command == "where") return place();
  if (command == "resume" && faulty_) throw std::runtime_error("the run cannot continue: go back");
  if (command == "resume" && at_end()) throw std::runtime_error("the record ends here: go back, or branch");
  if (const auto more = time_.execute(command, text, value)) return place() + *more;
  return change(command, value, text);
}

std::string ResimulatedRun::branch(const std::string& programs_text) {
  if (branched_) throw std::runtime_error(fmt::format("this is branch {} already", control_.branch));
  if (catch_up_) throw std::runtime_error("the run is going back: wait until it is there");
  if (!programs_text.empty() && programs_text != "recorded" && programs_text != "restarted")
    throw std::runtime_error("'branch' takes 'recorded', 'restarted' or nothing, got '" +
                             sim::shortened(programs_text) + "'");
  if (programs_text == "restarted" && !programs_)
    throw std::runtime_error("no programs can be started: the command needs --launch, and the world `processes`");
  const std::int64_t step = world().step_number();
  restarted_ = programs_ && programs_text != "recorded";
  if (restarted_) {
    try {
      start_programs(step);
    } catch (const experiment::RunError&) {
      // The record is shown from its start again.
      restarted_ = false;
      replayed_.restore_inputs();
      go_to_start();
      control_.set_paused(true);
      page_.jump();
      throw;
    }
  }
  branched_ = true;
  page_.start(world(), std::nullopt, {"branched", programs()});
  if (!restarted_) start_branch();
  return place() + "; programs: " + programs();
}

/// Starts the programs at the first step of the record: they follow it up to this step, and then act.
void ResimulatedRun::start_programs(std::int64_t step) {
  programs_->stop();
  go_to_start();
  view_.discard();
  replayed_.drop_inputs_from(step);
  programs_->start();
  catch_up_ = step;
}

void ResimulatedRun::start_branch() {
  ++control_.branch;
  view_.set_branch(control_.branch);
  page_.moved(world(), control_, true, programs());
}

std::string ResimulatedRun::rewind(double seconds) {
  const std::int64_t target = time_.step_before(seconds, log_.begin_step());
  faulty_ = false;
  control_.clear_until();
  control_.set_paused(true);
  if (restarted_) {
    time_.forget_after(log_.begin_step() - 1);
    try {
      start_programs(target);
    } catch (const experiment::RunError& error) {
      fail(error.what());
      throw;
    }
    return place();
  }
  // The last state before it, then the steps from there, with the same inputs.
  if (const auto base = time_.newest_kept_until(target)) {
    time_.load_kept(*base);
    replayed_.repeat_inputs();
  } else {
    go_to_start();
  }
  if (branched_) {
    time_.forget_after(target);
    changes_.erase(changes_.lower_bound(target), changes_.end());
  }
  view_.discard();
  catch_up_ = target;
  if (world().step_number() >= target) arrive();
  return place();
}

/// Ends a way back: a branch is left for another one, a record is the same.
void ResimulatedRun::arrive() {
  catch_up_.reset();
  if (!branched_) return page_.jump();
  if (restarted_) programs_->set_acting(true);
  start_branch();
}

std::string ResimulatedRun::change(const std::string& command, double value, const std::string& text) {
  if (!branched_)
    throw std::runtime_error("'" + command + "': this is a record, which cannot be changed: branch here first");
  if (command != "do" && command != "spawn" && command != "remove")
    throw std::runtime_error("'" + command + "' is not possible in a record that is run again");
  shoal::sim_control_request_t request{};
  request.client = "live page";
  request.command = command;
  request.value = value;
  request.text = text;
  if (catch_up_) throw std::runtime_error("'" + command + "': the run is going back: wait until it is there");
  const std::string reply = replayed_.request(request);
  if (!restarted_) changes_.emplace(world().step_number(), request);
  return reply;
}

}  // namespace viewer
