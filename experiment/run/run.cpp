// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "bridges/base/bus_error.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/run/run_ports.hpp"
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
      buses_(loaded.config, options, page_tap()),
      others_(buses_.networks(), options.lcm_shared),
      world_(loaded.config, buses_.outer(),
             options.serial_ports ? ports_.wrap(serial_ports_of(loaded.config, options)) : sim::PortOpener(),
             [this](const std::string& name) -> sim::Bus& { return buses_.of(name); }),
      journal_(buses_.outer(), world_, ports_, [this] { return has_listeners() || buses_.gate().reads("sim.hash"); }),
      lockstep_(world_, control_, lockstep_buses()),
      service_(buses_.outer(), buses_.network(), world_, control_, lockstep_,
               {sim::to_yaml(loaded.resolved), version_text(), build_text(), files_}, service_links()),
      scoring_(
          world_,
          options.quiet ? FirstContacts::Report() : [this](const std::string& line) { progress_.report(line); }),
      view_(
          buses_.outer(), world_, [this](shoal::sim_scores_t& message) { fill_scores(scoring_, message); },
          [this] { return has_listeners(); }),
      inputs_(buses_, journal_, service_, lockstep_),
      branch_log_(buses_, journal_, options.record, options.overwrite),
      time_(world_, control_, scoring_, service_, inputs_, time_options(), *this),
      duration_s_(options.duration_s.value_or(loaded.config.run.duration_s)),
      progress_(duration_s_, options.quiet || !sim::log_shows(sim::LogLevel::info)),
      key_file_(make_key()),
      programs_(loaded.config, options, buses_, key_file_ ? key_file_->key().text() : "") {
  world_.use_threads(options.threads);
  world_.state().measure_shared_work(&shared_work_);
  if (page_) page_->allow_drive(drive_publisher());
  control_.speed = options.speed.value_or(loaded.config.run.speed);
  control_.paused = options.paused;
  if (options.from) {
    try {
      time_.go_on_from(*options.from);
    } catch (const std::runtime_error& error) {
      throw RunError(2, "configuration", options.from_file + ": " + error.what());
    }
    // Earlier messages are not in this run's log, which a gap indicates.
    journal_.start_branch(control_.branch, 1);
  }
  if (!options.results.empty()) results_ = std::make_unique<Results>(options.results, world_, options.plots);
  progress_.restart(world_.now());
  plan_snapshots();
  if (options.keys && !options.quiet && TerminalKeys::possible()) {
    keys_ = std::make_unique<RunKeys>(
        time_, control_, [this](const std::string& text) { progress_.report(text); },
        [this](const std::string& text) { progress_.send_request(text); });
    progress_.report(RunKeys::help());
  }
}

std::vector<bridges::LockstepBus> Run::lockstep_buses() {
  const bool is_recorded = !options_.record.empty();
  std::vector<bridges::LockstepBus> all{{buses_.network(), buses_.gate(), "", is_recorded}};
  for (const sim::BusConfig& bus : loaded_.config.buses)
    all.push_back({buses_.network(bus.name), buses_.gate(bus.name), bus.name, is_recorded});
  return all;
}

bridges::ServiceLinks Run::service_links() {
  bridges::ServiceLinks links{&journal_, &others_};
  links.publish_scene = [this] { view_.request_scene(); };
  links.bus_url = [this](sim::Bus& bus) { return buses_.url(buses_.name_of(bus)); };
  for (const sim::BusConfig& bus : loaded_.config.buses) links.vehicle_buses.push_back(&buses_.network(bus.name));
  return links;
}

std::unique_ptr<RunKeyFile> Run::make_key() {
  const bool from_elsewhere = buses_.over_lcm() && buses_.leave_machine();
  if (from_elsewhere && options_.open_control)
    sim::log_warn("--open-control: any program that reaches the network of this run can control it");
  if (!buses_.over_lcm() || options_.open_control || (!from_elsewhere && !options_.control_key)) return nullptr;
  auto file = std::make_unique<RunKeyFile>(options_.results);
  lockstep_.guard().require(file->key());
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
    const sim::Vehicle* driven = world_.find_vehicle(vehicle);
    if (driven == nullptr) return;
    // Published on the network: for the world a message from outside, which waits at the gate and is in the journal.
    buses_.network(buses_.name_of(driven->bus())).publish(channel, payload, world_.now());
  };
}

void Run::serve_page() {
  page_->serve(world_, view_, control_, service_.waits_for(),
               [this](const std::string& command, double value, const std::string& text) -> RunPage::Answer {
                 shoal::sim_control_request_t request{};
                 request.client = "live page";
                 request.command = command;
                 request.value = value;
                 request.text = text;
                 try {
                   return {true, service_.execute_local(request, &time_)};
                 } catch (const std::runtime_error& error) {
                   return {false, error.what()};
                 }
               });
}

void Run::execute() {
  service_.handle_requests(&time_);
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
    page_->ended(world_, control_, summary.ended + (summary.error.empty() ? "" : ": " + summary.error),
                 options_.record);
  summary.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  finish(summary);
  return summary;
}

std::string Run::how_ended() const {
  if (caught_signal() != 0) return "signal";
  if (world_.ended()) return "event";
  if (must_end()) return "changed";
  return control_.quit ? "quit" : "duration";
}

bool Run::must_end() const {
  return caught_signal() != 0 || (options_.leave && options_.leave());
}

bool Run::may_continue() const {
  return !control_.quit && !must_end();
}

void Run::start_clients() {
  if (const auto other = others_.look([this](std::chrono::milliseconds time) { buses_.wait(time); })) {
    alone_ = false;
    throw RunError(
        4, "bus",
        *other +
            "; clients and reports of the two runs would mix: end the other one with `shoal control quit`, choose "
            "another port with --lcm-url, or share this one with --lcm-shared");
  }
  service_.publish_info();  // so that the first event of a log describes its run
  if (options_.from) publish_snapshot();
  buses_.end_of_step();
  const std::vector<std::string> clients = programs_.start();
  await(clients);
  if (!clients.empty()) service_.publish_info();  // they have missed the first one
}

void Run::await(const std::vector<std::string>& clients) {
  const auto begin = Clock::now();
  const auto deadline = begin + std::chrono::duration<double>(loaded_.config.lockstep.join_timeout_s);
  for (const std::string& client : clients) {
    bool reported = false;
    // Wait for the client, serving requests.
    while (!lockstep_.has(client) && may_continue()) {
      service_.handle_requests(&time_);
      check_programs();
      check_bus();
      if (programs_.is_gone(client)) break;
      // Report a timeout or a long wait.
      if (Clock::now() > deadline)
        throw RunError(
            5, "timeout",
            fmt::format("lockstep: client '{}' has not joined within {:g} s; clients that have: {}", client,
                        loaded_.config.lockstep.join_timeout_s, lockstep_.empty() ? "none" : lockstep_.names()));
      if (!reported && Clock::now() - begin > std::chrono::seconds(1)) {
        sim::log_info("waiting for '{}' to join the lockstep", client);
        reported = true;
      }
      buses_.wait(std::chrono::milliseconds(20));
    }
  }
}

void Run::loop() {
  journal_.start();
  if (page_) {
    page_->start(world_, duration_s_, {});
    progress_.report("live page: " + page_->url());
    page_->announce();
  }
  end_of_step();
  const sim::Time end = duration_s_ > 0 ? sim::from_seconds(duration_s_) : sim::Time::max();
  while (may_continue() && !world_.ended() && world_.now() < end) {
    // Requests and pauses.
    execute();
    if (time_.take_moved()) synchronized_ = false;
    if (!control_.may_step()) {
      progress_.update(world_.now(), messages(), control_, true);
      check_programs();
      check_bus();
      buses_.hand_over_record();
      buses_.wait(std::chrono::milliseconds(20));
      continue;
    }
    // Pace, then step or wait for clients.
    if (synchronized_) pace();
    if (!control_.may_step() || time_.has_moved()) continue;
    if (synchronized_)
      step();
    else
      synchronize();
  }
}

void Run::step() {
  admit_messages();
  watch_.begin();
  world_.step();
  watch_.end();
  ++steps_taken_;
  control_.step_taken();
  end_of_step();
  check_step_time();
  if (const auto error = buses_.record_error()) throw RunError(4, "bus", *error);
  if (results_)
    if (const auto error = results_->error()) throw RunError(4, "bus", *error);
  if (world_.step_number() % 100 == 0) check_bus();
  // Checking for ended children costs a system call; ten times per simulated second are sufficient.
  if (world_.step_number() % 10 == 0) check_programs();
  progress_.update(world_.now(), messages(), control_, false);
}

void Run::check_step_time() {
  if (const auto warning = watch_.take_warning()) {
    progress_.clear();
    sim::log_warn("{}", *warning);
  }
  if (const auto why = watch_.beyond_limit()) throw RunError(5, "limit", *why);
}

void Run::admit_messages() {
  buses_.set_time(world_.now());
  buses_.admit([this](const std::string& bus, std::span<const sim::MessageGate::Delivery> inputs) {
    journal_.admitted(bus, inputs);
    if (!page_) return;
    for (const sim::MessageGate::Delivery& input : inputs) page_->message(input.channel, input.payload, world_.now());
  });
}

void Run::end_of_step() {
  service_.publish_step();
  if (steps_taken_ > 0) scoring_.after_step();
  view_.after_step();
  journal_.after_step();  // in a record, what it publishes ends a step
  if (page_) page_->after_step(world_, view_, control_);
  if (results_ && steps_taken_ > 0) results_->after_step();
  buses_.end_of_step();
  time_.after_step();
  if (const auto oldest = time_.oldest_step()) branch_log_.mark(world_.step_number(), *oldest);
  take_snapshots();
  if (time_.stop_when_there()) progress_.restart(world_.now());
  synchronize();
}

void Run::synchronize() {
  const auto outcome = lockstep_.synchronize([this](std::chrono::milliseconds time) { buses_.wait(time); },
                                             [this] {
                                               execute();
                                               if (control_.paused)
                                                 progress_.update(world_.now(), messages(), control_, true);
                                               check_programs();
                                               check_bus();
                                               buses_.hand_over_record();
                                               return !must_end() && !time_.has_moved();
                                             });
  synchronized_ = outcome == bridges::LockstepOutcome::done && !time_.has_moved();
}

void Run::pace() {
  const sim::Time next = world_.now() + world_.step_time();
  for (auto wait = pacer_.until(next, control_); wait.count() > 0 && may_continue() && control_.may_step();
       wait = pacer_.until(next, control_)) {
    if (wait > std::chrono::milliseconds(2)) {
      buses_.hand_over_record();
      const auto nap = std::chrono::duration_cast<std::chrono::milliseconds>(wait) - std::chrono::milliseconds(1);
      buses_.wait(std::min(nap, std::chrono::milliseconds(20)));
    } else {
      std::this_thread::sleep_for(wait);
    }
    execute();
    if (time_.has_moved()) return;
  }
}

void Run::check_bus() const {
  if (const auto lost = buses_.lost_connection()) throw RunError(4, "bus", *lost);
}

RunPrograms::Clients Run::clients(bool goes_on) {
  return {[this, goes_on](const std::string& client) {
            if (goes_on) service_.handle_requests(&time_);  // the last request may be to leave
            return lockstep_.has_left(client);
          },
          [this](const std::string& client) {
            progress_.clear();
            service_.client_exited(client);
            return !lockstep_.has(client);
          },
          [this](const std::string& client) {
            return RunPrograms::Left{lockstep_.reason_to_leave(client), lockstep_.end_s(client)};
          }};
}

void Run::check_programs() {
  programs_.check(world_.now(), clients(true));
}

std::uint64_t Run::messages() const {
  const sim::BusCounts counts = buses_.counts();
  return counts.published + counts.received;
}

}  // namespace experiment
