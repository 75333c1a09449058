#include "tools/experiment/runner.hpp"

#include <signal.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "bridges/lcm/bus_error.hpp"
#include "bridges/lcm/run_journal.hpp"
#include "bridges/lcm/sim_service.hpp"
#include "bridges/serial/serial_port.hpp"
#include "devices/serial_port.hpp"
#include "sim/acoustics/channel.hpp"
#include "tools/experiment/process_group.hpp"
#include "tools/experiment/progress.hpp"
#include "tools/experiment/run_buses.hpp"
#include "tools/experiment/run_identity.hpp"

namespace tools {

namespace {

using Clock = std::chrono::steady_clock;

std::atomic<int> signal_caught{0};

std::atomic<int> signals_caught{0};

void on_signal(int signal) {
  signal_caught = signal;
  ++signals_caught;
}

/// An error that ends the run, with its exit code.
struct RunError : std::runtime_error {
  RunError(int code, std::string how_ended, const std::string& text)
      : std::runtime_error(text), exit_code(code), ended(std::move(how_ended)) {}
  int exit_code;
  std::string ended;
};

/// Holds simulated time to a multiple of wall time.
class Pacer {
 public:
  /// How long to wait before the step that ends at `next`.
  std::chrono::microseconds until(sim::Time next, const sim::RunControl& control) {
    if (control.speed <= 0) return std::chrono::microseconds{0};
    const Clock::time_point now = Clock::now();
    if (!started_ || changes_ != control.changes) start(next, now, control);
    const auto ahead = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(sim::to_seconds(next - sim_start_) / control.speed));
    const auto wait = std::chrono::duration_cast<std::chrono::microseconds>(wall_start_ + ahead - now);
    // Too slow a machine: go on from here rather than race to catch up.
    if (wait < std::chrono::milliseconds(-500)) start(next, now, control);
    return std::max(wait, std::chrono::microseconds{0});
  }

 private:
  void start(sim::Time next, Clock::time_point now, const sim::RunControl& control) {
    started_ = true;
    changes_ = control.changes;
    sim_start_ = next;
    wall_start_ = now;
  }

  bool started_ = false;
  std::int64_t changes_ = 0;
  sim::Time sim_start_{0};
  Clock::time_point wall_start_;
};

/// When there is a worse error to tell of already.
void try_to_write_summary(const std::string& directory, const Summary& summary) {
  try {
    write_summary(directory, summary);
  } catch (const std::exception& error) {
    spdlog::debug("{}", error.what());
  }
}

class Run {
 public:
  Run(const sim::LoadedWorld& loaded, const RunOptions& options)
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
        progress_(duration_s_, options.quiet) {
    journal_.attach(world_);
    service_.use_journal(journal_);
    world_.use_threads(options.threads);
    for (sim::Bus* bus : buses_.other_networks()) service_.serve_vehicles(*bus);
    control_.speed = options.speed.value_or(loaded.config.run.speed);
    control_.paused = options.paused;
    if (!options.results.empty()) results_ = std::make_unique<Results>(options.results, world_, options.pictures);
  }

  Summary go() {
    Summary summary;
    const Clock::time_point begin = Clock::now();
    try {
      start_clients();
      loop();
      summary.ended = how_ended();
      if (signal_caught != 0) summary.exit_code = 128 + signal_caught;
    } catch (const RunError& error) {
      fail(summary, error.exit_code, error.ended, error.what());
    } catch (const sim::PhysicsFault& error) {
      fail(summary, 3, "fault", error.what());
    } catch (const bridges::LockstepTimeout& error) {
      fail(summary, 5, "timeout", error.what());
    } catch (const std::exception& error) {
      fail(summary, 4, "error", error.what());
    }
    progress_.clear();
    summary.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
    finish(summary);
    return summary;
  }

 private:
  static void fail(Summary& summary, int exit_code, const std::string& ended, const std::string& error) {
    summary.exit_code = exit_code;
    summary.ended = ended;
    summary.error = error;
  }

  std::string how_ended() const {
    if (signal_caught != 0) return "signal";
    if (world_.ended()) return "event";
    return control_.quit ? "quit" : "duration";
  }

  bool wanted() const { return signal_caught == 0 && !control_.quit; }

  void start_clients() {
    std::vector<std::string> awaited = options_.await;
    const bool takes_clients = !awaited.empty() || (options_.launch && !loaded_.config.processes.empty());
    if (takes_clients && buses_.over_lcm() &&
        service_.hears_another_simulator([this](std::chrono::milliseconds time) { buses_.wait(time); })) {
      alone_ = false;
      throw RunError(4, "bus",
                     "another simulator publishes on " + buses_.url("") +
                         "; their clients would mix: choose another port with --lcm-url");
    }
    service_.publish_info();  // a log tells of its run from the first event
    buses_.end_of_step();
    if (options_.launch) {
      for (const sim::ProcessConfig& process : loaded_.config.processes) {
        try {
          processes_.start(process, buses_.url(process.bus), options_.results);
        } catch (const std::runtime_error& error) {
          throw RunError(4, "process", error.what());
        }
        if (!process.client.empty()) awaited.push_back(process.client);
      }
    } else if (!loaded_.config.processes.empty() && !options_.quiet) {
      spdlog::info("the world names {} processes; --launch starts them", loaded_.config.processes.size());
    }
    await(awaited);
  }

  void await(const std::vector<std::string>& clients) {
    const auto begin = Clock::now();
    const auto deadline = begin + std::chrono::duration<double>(loaded_.config.lockstep.join_timeout_s);
    for (const std::string& client : clients) {
      bool said = false;
      while (!lockstep_.has(client) && wanted()) {
        service_.handle_requests();
        check_processes();
        check_bus();
        if (gone_.count(client) > 0) break;
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

  void loop() {
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
        check_processes();
        check_bus();
        buses_.wait(std::chrono::milliseconds(20));
        continue;
      }
      pace();
      if (!control_.may_step()) continue;
      step();
    }
  }

  void step() {
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
    if (world_.step_number() % 10 == 0) check_processes();
    progress_.update(world_.now(), messages(), false);
  }

  void synchronize() {
    service_.synchronize(
        loaded_.config.lockstep.timeout_s, [this](std::chrono::milliseconds time) { buses_.wait(time); },
        [this] {
          check_processes();
          check_bus();
          return signal_caught == 0;
        });
  }

  /// Waits until the next step is due, answering requests meanwhile.
  void pace() {
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

  void check_bus() const {
    if (const auto lost = buses_.lost_connection()) throw RunError(4, "bus", *lost);
  }

  void check_processes() {
    if (processes_.empty()) return;
    for (const ProcessGroup::Exit& exit : processes_.reap()) {
      progress_.clear();
      const std::string text = "process '" + exit.name + "' " + exit.how;
      ended_processes_.push_back({exit.name, exit.how, sim::to_seconds(world_.now())});
      if (exit.ends_run) throw RunError(1, "process", text + "; the world says the run ends with it");
      if (exit.failed)
        spdlog::error("{}; the run goes on without it", text);
      else
        spdlog::info("{}", text);
      gone_[exit.client] = true;
      service_.client_gone(exit.client);
    }
  }

  std::uint64_t messages() const {
    const sim::BusCounts counts = buses_.counts();
    return counts.published + counts.received;
  }

  void finish(Summary& summary) {
    journal_.finish();
    if (alone_) {  // else it would end the other simulator's clients
      service_.publish_end();
      if (signal_caught == 0) processes_.await_clients();
    }
    processes_.stop();
    buses_.close_record();
    if (const auto error = buses_.record_error(); error && summary.exit_code == 0) fail(summary, 4, "bus", *error);
    const sim::BusCounts counts = buses_.counts();
    summary.world = loaded_.config.name;
    summary.seed = loaded_.config.run.seed;
    summary.version = short_version();
    summary.steps = world_.step_number();
    summary.sim_time_s = sim::to_seconds(world_.now());
    summary.state_hash = world_.state_hash();
    summary.messages = counts.published + counts.received;
    summary.dropped_messages = counts.dropped_incoming + counts.dropped_outgoing;
    summary.bad_messages = world_.counts().bad_messages + service_.bad_messages() + scoring_.bad_messages();
    summary.quick_steps = world_.physics().quick_steps();
    const LinkCounts links = link_counts(world_, "", "");
    if (!world_.acoustics().transducers().empty()) summary.acoustics = links;
    summary.serial_dropped_bytes = devices::serial_dropped_bytes(world_);
    summary.metrics = scoring_.figures();
    summary.verdicts = scoring_.verdicts();
    summary.processes = ended_processes_;
    summary.event = world_.ended();
    for (const auto& [vehicle, record] : world_.zone_records()) summary.zones[vehicle] = record;
    // Without the programs that a world names there is nothing to judge.
    const bool judged = loaded_.config.processes.empty() || options_.launch || !options_.await.empty();
    if (!judged) summary.verdicts.clear();
    if (summary.exit_code == 0 && !summary.passed()) summary.exit_code = 1;  // a rule, or the event that ended it
    note_signal(summary);
    if (results_) write_results(summary);
  }

  /// One that came while the run was ending counts as well.
  static void note_signal(Summary& summary) {
    if (signal_caught != 0 && summary.exit_code <= 1 && summary.error.empty())
      fail(summary, 128 + signal_caught, "signal", "");
  }

  void write_results(Summary& summary) {
    const int exit_code = summary.exit_code;
    const int signals = signals_caught;
    try {
      results_->finish(summary, scoring_, loaded_.resolved, [&] { return signals_caught != signals; });
    } catch (const std::exception& error) {
      if (summary.exit_code <= 1 && summary.error.empty()) fail(summary, 4, "bus", error.what());
    }
    note_signal(summary);
    if (summary.exit_code != exit_code) try_to_write_summary(options_.results, summary);
  }

  const sim::LoadedWorld& loaded_;
  const RunOptions& options_;
  RunBuses buses_;
  sim::RunControl control_;
  sim::Lockstep lockstep_;
  bridges::RunJournal journal_;
  sim::World world_;
  bridges::SimService service_;
  Scoring scoring_;
  double duration_s_;
  Progress progress_;
  Pacer pacer_;
  ProcessGroup processes_;
  std::vector<Summary::Process> ended_processes_;
  bool alone_ = true;  ///< no other simulator was heard at the start
  std::map<std::string, bool> gone_;
  std::unique_ptr<Results> results_;
};

}  // namespace

Summary run_world(const sim::LoadedWorld& loaded, const RunOptions& options) {
  Summary summary;
  summary.world = loaded.config.name;
  summary.seed = loaded.config.run.seed;
  summary.version = short_version();
  const auto fail = [&](int exit_code, const std::string& ended, const char* error) {
    summary.exit_code = exit_code;
    summary.ended = ended;
    summary.error = error;
    if (!options.results.empty()) try_to_write_summary(options.results, summary);
  };
  // An old summary would be taken for this run's if this one were killed.
  std::error_code ignored;
  if (!options.results.empty()) std::filesystem::remove(options.results + "/summary.json", ignored);
  try {
    if (options.launch && options.bus == "none")
      throw RunError(2, "configuration", "--launch needs the LCM bus: processes cannot attach to --bus none");
    return Run(loaded, options).go();
  } catch (const sim::ConfigError& error) {
    fail(2, "configuration", error.what());
    throw;
  } catch (const RunError& error) {
    fail(error.exit_code, error.ended, error.what());
  } catch (const std::exception& error) {  // bus, record, serial port or results could not be opened
    fail(4, "bus", error.what());
  }
  return summary;
}

void catch_signals(bool ignore_pipe) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;  // nohup
    sigaction(signal, &action, nullptr);
  }
  if (ignore_pipe) ::signal(SIGPIPE, SIG_IGN);
}

int caught_signal() {
  return signal_caught;
}

}  // namespace tools
