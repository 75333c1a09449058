#include "tools/experiment/run.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

#include "bridges/lcm/bus_error.hpp"
#include "bridges/serial/serial_port.hpp"
#include "tools/experiment/run_error.hpp"
#include "tools/experiment/run_identity.hpp"

namespace tools {

namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Run::Run(const sim::LoadedWorld& loaded, const RunOptions& options)
    : loaded_(loaded),
      options_(options),
      buses_(loaded.config, options),
      journal_(buses_.outer()),
      world_(loaded.config, buses_.outer(),
             options.serial_ports ? journal_.wrap(bridges::open_serial_port) : sim::PortOpener(),
             [this](const std::string& name) -> sim::Bus& { return buses_.of(name); }),
      service_(buses_.outer(), buses_.network(), world_, control_, lockstep_,
               {sim::to_yaml(loaded.resolved), version_text(), build_text(), files_text(loaded.resolved)}),
      scoring_(world_),
      duration_s_(options.duration_s.value_or(loaded.config.run.duration_s)),
      progress_(duration_s_, options.quiet),
      programs_(loaded.config, options, buses_) {
  journal_.attach(world_);
  service_.use_journal(journal_);
  world_.use_threads(options.threads);
  for (sim::Bus* bus : buses_.other_networks()) service_.serve_vehicles(*bus);
  control_.speed = options.speed.value_or(loaded.config.run.speed);
  control_.paused = options.paused;
  if (!options.results.empty()) results_ = std::make_unique<Results>(options.results, world_, options.pictures);
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
  summary.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  finish(summary);
  return summary;
}

std::string Run::how_ended() const {
  if (caught_signal() != 0) return "signal";
  if (world_.ended()) return "event";
  return control_.quit ? "quit" : "duration";
}

bool Run::wanted() const {
  return caught_signal() == 0 && !control_.quit;
}

void Run::start_clients() {
  const bool takes_clients = !options_.await.empty() || (options_.launch && !loaded_.config.processes.empty());
  if (takes_clients && buses_.over_lcm() &&
      service_.hears_another_simulator([this](std::chrono::milliseconds time) { buses_.wait(time); })) {
    alone_ = false;
    throw RunError(4, "bus",
                   "another simulator publishes on " + buses_.url("") +
                       "; their clients would mix: choose another port with --lcm-url");
  }
  service_.publish_info();  // a log tells of its run from the first event
  buses_.end_of_step();
  await(programs_.start());
}

void Run::await(const std::vector<std::string>& clients) {
  const auto begin = Clock::now();
  const auto deadline = begin + std::chrono::duration<double>(loaded_.config.lockstep.join_timeout_s);
  for (const std::string& client : clients) {
    bool said = false;
    while (!lockstep_.has(client) && wanted()) {
      service_.handle_requests();
      check_programs();
      check_bus();
      if (programs_.is_gone(client)) break;
      if (Clock::now() > deadline)
        throw RunError(5, "timeout",
                       "lockstep: client '" + client + "' has not joined within " +
                           std::to_string(loaded_.config.lockstep.join_timeout_s) + " s");
      if (!said && Clock::now() - begin > std::chrono::seconds(1)) {
        spdlog::info("waiting for '{}' to join the lockstep", client);
        said = true;
      }
      buses_.wait(std::chrono::milliseconds(20));
    }
  }
}

void Run::loop() {
  journal_.start();
  service_.publish_step();
  journal_.after_step();
  buses_.end_of_step();
  synchronize();
  const sim::Time end = duration_s_ > 0 ? sim::from_seconds(duration_s_) : sim::Time::max();
  while (wanted() && !world_.ended() && world_.now() < end) {
    service_.handle_requests();
    if (!control_.may_step()) {
      progress_.update(world_.now(), messages(), true);
      check_programs();
      check_bus();
      buses_.wait(std::chrono::milliseconds(20));
      continue;
    }
    pace();
    if (!control_.may_step()) continue;
    step();
  }
}

void Run::step() {
  buses_.set_time(world_.now());
  buses_.admit(
      [this](const std::string& bus, std::span<const sim::MailGate::Mail> mail) { journal_.admitted(bus, mail); });
  world_.step();
  control_.step_taken();
  service_.publish_step();
  journal_.after_step();
  scoring_.after_step();
  if (results_) results_->after_step();
  buses_.end_of_step();
  synchronize();
  if (const auto error = buses_.record_error()) throw RunError(4, "bus", *error);
  if (results_)
    if (const auto error = results_->error()) throw RunError(4, "bus", *error);
  if (world_.step_number() % 100 == 0) check_bus();
  // Looking for dead children costs a system call; ten times a simulated second will do.
  if (world_.step_number() % 10 == 0) check_programs();
  progress_.update(world_.now(), messages(), false);
}

void Run::synchronize() {
  service_.synchronize(
      loaded_.config.lockstep.timeout_s, [this](std::chrono::milliseconds time) { buses_.wait(time); },
      [this] {
        check_programs();
        check_bus();
        return caught_signal() == 0;
      });
}

void Run::pace() {
  const sim::Time next = world_.now() + world_.step_time();
  for (auto wait = pacer_.until(next, control_); wait.count() > 0 && wanted() && control_.may_step();
       wait = pacer_.until(next, control_)) {
    if (wait > std::chrono::milliseconds(2)) {
      const auto nap = std::chrono::duration_cast<std::chrono::milliseconds>(wait) - std::chrono::milliseconds(1);
      buses_.wait(std::min(nap, std::chrono::milliseconds(20)));
    } else {
      std::this_thread::sleep_for(wait);
    }
    service_.handle_requests();
  }
}

void Run::check_bus() const {
  if (const auto lost = buses_.lost_connection()) throw RunError(4, "bus", *lost);
}

void Run::check_programs() {
  programs_.check(world_.now(), [this](const std::string& client) {
    progress_.clear();
    service_.client_gone(client);
  });
}

std::uint64_t Run::messages() const {
  const sim::BusCounts counts = buses_.counts();
  return counts.published + counts.received;
}

}  // namespace tools
