// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "bridges/base/bus_error.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/run/scores_message.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "sim/base/log.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {

namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Run::Run(const sim::LoadedWorld& loaded, const RunOptions& options)
    : loaded_(loaded),
      options_(options),
      page_(options.page ? options.page() : nullptr),
      files_(files_text(loaded.resolved)),
      parts_(loaded, options, parts_options()),
      scoring_(
          parts_.world,
          options.quiet ? FirstContacts::Report() : [this](const std::string& line) { progress_.report(line); }),
      view_(
          parts_.buses.outer(), parts_.world, [this](shoal::sim_scores_t& message) { fill_scores(scoring_, message); },
          [this] { return parts_.buses.has_listeners(); }),
      inputs_(parts_.buses, parts_.journal, parts_.service, parts_.lockstep),
      branch_log_(parts_.buses, parts_.journal, options.record, options.overwrite),
      time_(parts_.world, parts_.control, scoring_, parts_.service, inputs_, time_options(), *this),
      duration_s_(options.duration_s.value_or(loaded.config.run.duration_s)),
      snapshot_plan_(options.snapshot_at_s, options.snapshot_every_s,
                     {parts_.world.step_time(), options.from ? options.from->step : 0, duration_s_}),
      progress_(duration_s_, options.quiet || !sim::log_shows(sim::LogLevel::info)),
      key_file_(make_key()),
      programs_(options, parts_, time_, key_file_ ? key_file_->key().text() : "") {
  parts_.world.use_threads(options.threads);
  parts_.world.state().measure_shared_work(&shared_work_);
  if (page_) page_->allow_drive(drive_publisher());
  parts_.control.speed = options.speed.value_or(loaded.config.run.speed);
  parts_.control.paused = options.paused;
  if (options.from) {
    try {
      time_.go_on_from(*options.from);
    } catch (const std::runtime_error& error) {
      throw RunError(2, "configuration", options.from_file + ": " + error.what());
    }
    // Earlier messages are not in this run's log, which a gap indicates.
    parts_.journal.start_branch(parts_.control.branch, 1);
  }
  if (!options.results.empty()) results_ = std::make_unique<Results>(options.results, parts_.world, options.plots);
  progress_.restart(parts_.world.now());
  check_planned_snapshots();
  if (options.keys && !options.quiet && TerminalKeys::possible()) {
    keys_ = std::make_unique<RunKeys>(
        time_, parts_.control, [this](const std::string& text) { progress_.report(text); },
        [this](const std::string& text) { progress_.send_request(text); });
    progress_.report(RunKeys::help());
  }
}

RunParts::Options Run::parts_options() {
  RunParts::Options parts;
  parts.files = files_;
  parts.tap = page_tap();
  parts.publish_scene = [this] { view_.request_scene(); };
  return parts;
}

std::unique_ptr<RunKeyFile> Run::make_key() {
  const bool from_elsewhere = parts_.buses.over_lcm() && parts_.buses.leave_machine();
  if (from_elsewhere && options_.open_control)
    sim::log_warn("--open-control: any program that reaches the network of this run can control it");
  if (!parts_.buses.over_lcm() || options_.open_control || (!from_elsewhere && !options_.control_key)) return nullptr;
  auto file = std::make_unique<RunKeyFile>(options_.results);
  parts_.lockstep.guard().require(file->key());
  sim::log_info("control of this run needs its key: shoal control --run {}, or SHOAL_RUN_KEY", file->folder());
  return file;
}

TimeControl::Options Run::time_options() const {
  constexpr double usual_rewind_s = 60;
  const bool accepts_requests =
      options_.page || options_.bus != "none" || (options_.keys && !options_.quiet && TerminalKeys::possible());
  TimeControl::Options time;
  time.rewind_s = options_.rewind_s.value_or(accepts_requests ? usual_rewind_s : 0);
  time.max_bytes = static_cast<std::size_t>(options_.rewind_MB * 1e6);
  time.directory = options_.snapshots;
  if (time.directory.empty() && !options_.results.empty()) {
    time.directory = options_.results + "/snapshots";
    refuse_links(options_.results, time.directory);
  }
  time.overwrite = options_.overwrite;
  time.resolved_world = sim::to_yaml(loaded_.resolved);
  time.files = files_;
  time.version = short_version();
  return time;
}

TapBus::Listener Run::page_tap() {
  if (!page_) return {};
  return [this](std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
    page_->message(channel, payload, at);
  };
}

RunPage::Publish Run::drive_publisher() {
  return [this](const std::string& vehicle, const std::string& channel, std::span<const std::byte> payload) {
    const sim::Vehicle* driven = parts_.world.find_vehicle(vehicle);
    if (driven == nullptr) return;
    // Published on the network: for the world a message from outside, which waits at the gate and is in the journal.
    parts_.buses.network(parts_.buses.name_of(driven->bus())).publish(channel, payload, parts_.world.now());
  };
}

void Run::serve_page() {
  const auto carry_out = [this](const std::string& command, double value, const std::string& text) {
    shoal::sim_control_request_t request{};
    request.client = "live page";
    request.command = command;
    request.value = value;
    request.text = text;
    return parts_.service.execute_local(request, &time_);
  };
  page_->serve(parts_.world, view_, parts_.control, parts_.service.waits_for(), RunPage::answering(carry_out));
}

void Run::execute() {
  parts_.service.handle_requests(&time_);
  if (page_) serve_page();
  if (keys_) keys_->read();
  if (!time_.broken().empty()) throw RunError(3, "fault", time_.broken());
}

Summary Run::go() {
  Summary summary;
  const Clock::time_point begin = Clock::now();
  try {
    start_clients();
    loop();
    summary.ended = how_ended();
    if (caught_signal() != 0) summary.exit_code = 128 + caught_signal();
  } catch (const RunError& error) {
    summary.fail(error.exit_code, error.ended, error.what());
  } catch (const sim::PhysicsFault& error) {
    summary.fail(3, "fault", error.what());
  } catch (const bridges::LockstepTimeout& error) {
    summary.fail(5, "timeout", error.what());
  } catch (const std::exception& error) {
    summary.fail(4, "error", error.what());
  }
  progress_.clear();
  if (page_)
    page_->ended(parts_.world, parts_.control, summary.ended + (summary.error.empty() ? "" : ": " + summary.error),
                 options_.record);
  summary.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  finish(summary);
  return summary;
}

std::string Run::how_ended() const {
  if (caught_signal() != 0) return "signal";
  if (parts_.world.ended()) return "event";
  if (must_end()) return "changed";
  return parts_.control.quit ? "quit" : "duration";
}

bool Run::must_end() const {
  return caught_signal() != 0 || (options_.leave && options_.leave());
}

bool Run::may_continue() const {
  return !parts_.control.quit && !must_end();
}

void Run::start_clients() {
  if (const auto other =
          parts_.other_simulators.look([this](std::chrono::milliseconds time) { parts_.buses.wait(time); })) {
    alone_ = false;
    throw RunError(
        4, "bus",
        *other +
            "; clients and reports of the two runs would mix: end the other one with `shoal control quit`, choose "
            "another port with --lcm-url, or share this one with --lcm-shared");
  }
  parts_.service.publish_info();  // so that the first event of a log describes its run
  if (options_.from) publish_snapshot();
  parts_.buses.end_of_step();
  const std::vector<std::string> clients = programs_.start();
  await(clients);
  if (!clients.empty()) parts_.service.publish_info();  // they have missed the first one
}

void Run::await(const std::vector<std::string>& clients) {
  const auto begin = Clock::now();
  const auto deadline = begin + std::chrono::duration<double>(loaded_.config.lockstep.join_timeout_s);
  for (const std::string& client : clients) {
    bool reported = false;
    // Wait for the client, serving requests.
    while (!parts_.lockstep.has(client) && may_continue()) {
      parts_.service.handle_requests(&time_);
      check_programs();
      check_bus();
      if (programs_.is_gone(client)) break;
      // Report a timeout or a long wait.
      if (Clock::now() > deadline)
        throw RunError(5, "timeout",
                       fmt::format("lockstep: client '{}' has not joined within {:g} s; clients that have: {}", client,
                                   loaded_.config.lockstep.join_timeout_s,
                                   parts_.lockstep.empty() ? "none" : parts_.lockstep.names()));
      if (!reported && Clock::now() - begin > std::chrono::seconds(1)) {
        sim::log_info("waiting for '{}' to join the lockstep", client);
        reported = true;
      }
      parts_.buses.wait(std::chrono::milliseconds(20));
    }
  }
}

void Run::loop() {
  parts_.journal.start();
  if (page_) {
    page_->start(parts_.world, duration_s_, {});
    progress_.report("live page: " + page_->url());
    page_->announce();
  }
  end_of_step();
  const sim::Time end = duration_s_ > 0 ? sim::from_seconds(duration_s_) : sim::Time::max();
  while (may_continue() && !parts_.world.ended() && parts_.world.now() < end) {
    // Requests and pauses.
    execute();
    if (time_.take_moved()) synchronized_ = false;
    if (!parts_.control.may_step()) {
      progress_.update(parts_.world.now(), messages(), parts_.control, true);
      check_programs();
      check_bus();
      parts_.buses.hand_over_record();
      parts_.buses.wait(std::chrono::milliseconds(20));
      continue;
    }
    // Pace, then step or wait for clients.
    if (synchronized_) pace();
    if (!parts_.control.may_step() || time_.has_moved()) continue;
    if (synchronized_)
      step();
    else
      synchronize();
  }
}

void Run::step() {
  admit_messages();
  watch_.begin();
  parts_.world.step();
  watch_.end();
  ++steps_taken_;
  parts_.control.step_taken();
  end_of_step();
  check_step_time();
  if (const auto error = parts_.buses.record_error()) throw RunError(4, "bus", *error);
  if (results_)
    if (const auto error = results_->error()) throw RunError(4, "bus", *error);
  if (parts_.world.step_number() % 100 == 0) check_bus();
  // Checking for ended children costs a system call; ten times per simulated second are sufficient.
  if (parts_.world.step_number() % 10 == 0) check_programs();
  progress_.update(parts_.world.now(), messages(), parts_.control, false);
}

void Run::check_step_time() {
  if (const auto warning = watch_.take_warning()) {
    progress_.clear();
    sim::log_warn("{}", *warning);
  }
  if (const auto why = watch_.beyond_limit()) throw RunError(5, "limit", *why);
}

void Run::admit_messages() {
  parts_.buses.set_time(parts_.world.now());
  parts_.buses.admit([this](const std::string& bus, std::span<const sim::MessageGate::Delivery> inputs) {
    parts_.journal.admitted(bus, inputs);
    if (!page_) return;
    for (const sim::MessageGate::Delivery& input : inputs)
      page_->message(input.channel, input.payload, parts_.world.now());
  });
}

void Run::end_of_step() {
  parts_.service.publish_step();
  if (steps_taken_ > 0) scoring_.after_step();
  view_.after_step();
  parts_.journal.after_step();  // in a record, what it publishes ends a step
  if (page_) page_->after_step(parts_.world, view_, parts_.control);
  if (results_ && steps_taken_ > 0) results_->after_step();
  parts_.buses.end_of_step();
  time_.after_step();
  if (const auto oldest = time_.oldest_step()) branch_log_.mark(parts_.world.step_number(), *oldest);
  take_snapshots();
  if (time_.stop_when_there()) progress_.restart(parts_.world.now());
  synchronize();
}

void Run::synchronize() {
  const auto outcome =
      parts_.lockstep.synchronize([this](std::chrono::milliseconds time) { parts_.buses.wait(time); },
                                  [this] {
                                    execute();
                                    if (parts_.control.paused)
                                      progress_.update(parts_.world.now(), messages(), parts_.control, true);
                                    check_programs();
                                    check_bus();
                                    parts_.buses.hand_over_record();
                                    return !must_end() && !time_.has_moved();
                                  });
  synchronized_ = outcome == bridges::LockstepOutcome::done && !time_.has_moved();
}

void Run::pace() {
  const sim::Time next = parts_.world.now() + parts_.world.step_time();
  for (auto wait = pacer_.until(next, parts_.control); wait.count() > 0 && may_continue() && parts_.control.may_step();
       wait = pacer_.until(next, parts_.control)) {
    if (wait > std::chrono::milliseconds(2)) {
      parts_.buses.hand_over_record();
      const auto nap = std::chrono::duration_cast<std::chrono::milliseconds>(wait) - std::chrono::milliseconds(1);
      parts_.buses.wait(std::min(nap, std::chrono::milliseconds(20)));
    } else {
      std::this_thread::sleep_for(wait);
    }
    execute();
    if (time_.has_moved()) return;
  }
}

void Run::check_bus() const {
  if (const auto lost = parts_.buses.lost_connection()) throw RunError(4, "bus", *lost);
}

void Run::check_programs() {
  programs_.check([this] { progress_.clear(); });
}

std::uint64_t Run::messages() const {
  const sim::BusCounts counts = parts_.buses.counts();
  return counts.published + counts.received;
}

}  // namespace experiment
