// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/play.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/control/other_simulators.hpp"
#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/replay/played_answers.hpp"
#include "experiment/replay/player_requests.hpp"
#include "experiment/replay/recorded_steps.hpp"
#include "experiment/replay/replay_log.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/terminal/progress.hpp"
#include "experiment/time/pacer.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

ReplayLog read_record(const std::string& path) {
  ReplayLog log = read_replay_log(path);
  if (!log.own_stamps)
    throw RunError(4, "record",
                   path + ": is not stamped with simulated time; --play needs a record of shoal run --record");
  if (log.is_rewound)
    throw RunError(4, "record", path + ": holds several branches of a run; --play needs the record of one");
  if (log.first_step > log.begin_step())
    throw RunError(4, "record",
                   fmt::format("{}: begins at step {} without a snapshot; --play needs one there, or the whole record",
                               path, log.first_step));
  return log;
}

/// Empty world for the lockstep, with the time of the record and its rules about clients.
sim::LoadedWorld load_empty_world(const ReplayLog& log) {
  const double step_s = static_cast<double>(log.info.step_us) * 1e-6;
  sim::LoadedWorld empty =
      sim::load_world_text(fmt::format("shoal: 1\nphysics: {{step_s: {}}}\n", step_s), log.path, {});
  empty.config.name = log.info.world;
  empty.config.epoch_us = log.info.epoch_utime;
  try {
    sim::LoadOptions load;
    load.only_own_files = true;
    load.serial_ports = false;
    load.encode_message = shoal::encode_own_message;
    empty.config.lockstep = sim::load_world_text(log.info.resolved_config, log.path, load).config.lockstep;
  } catch (const std::exception&) {
    // A mesh or a plugin of that run may be missing here; the defaults are sufficient.
  }
  return empty;
}

class Player {
 public:
  explicit Player(const PlayOptions& options)
      : options_(options),
        log_(read_record(options.log)),
        empty_(load_empty_world(log_)),
        bus_(options.lcm_url),
        others_({{bus_.url(), &bus_}}, false),
        gate_(bus_),
        world_(empty_.config, inner_),
        lockstep_(world_, control_, {{bus_, gate_}}, false),
        service_(inner_, bus_, world_, control_, lockstep_, {log_.info.resolved_config, log_.info.versions},
                 {.others = &others_}),
        requests_(log_, control_, bus_, [this] { return where(); }),
        steps_(log_),
        answers_(log_),
        progress_(sim::to_seconds(world_.step_time()) * static_cast<double>(last_step()), options.quiet) {
    control_.speed = options.speed;
    for (const auto& [channel, known] : answers_.channels()) mailboxes_.push_back(gate_.open_mailbox(channel));
  }

  PlayOutcome run() {
    const auto wait = [this](milliseconds time) { bus_.wait_for_message(time); };
    if (const auto other = others_.look(wait))
      throw RunError(4, "bus",
                     *other + "; its messages and those of the record would mix: choose another port with --lcm-url");
    // The world is empty, so that stepping is fast; a damaged record may name a distant step.
    while (world_.step_number() < log_.begin_step() && may_continue()) world_.step();
    shoal::encode_into(log_.info, buffer_);
    publish("sim.info", buffer_);
    gate_.end_of_step();
    await_programs();
    const auto begin = Clock::now();
    play_steps();
    progress_.clear();
    const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
    lockstep_.publish_end(wait, milliseconds(caught_signal() == 0 ? 1000 : 200));
    return outcome(wall_s);
  }

 private:
  std::int64_t last_step() const {
    if (!options_.until_s) return log_.last_step;
    const double steps = std::floor(*options_.until_s * 1e6 / static_cast<double>(log_.info.step_us) + 1e-9);
    return std::min(log_.last_step, static_cast<std::int64_t>(std::min(steps, 1e15)));
  }

  bool may_continue() const { return caught_signal() == 0 && !control_.quit; }

  void execute() {
    requests_.check_joins();
    service_.handle_requests(&requests_);
    if (!bus_.connected()) throw RunError(4, "bus", "the connection to " + bus_.url() + " was lost");
  }

  std::string missing_programs() const {
    if (options_.await.empty()) return lockstep_.empty() ? "a program" : "";
    std::string names;
    for (const std::string& client : options_.await)
      if (!lockstep_.has(client)) names += (names.empty() ? "'" : ", '") + client + "'";
    return names;
  }

  void await_programs() {
    if (options_.join_timeout_s <= 0 && options_.await.empty()) return;
    const auto begin = Clock::now();
    bool reported = options_.quiet;
    for (std::string missing = missing_programs(); !missing.empty() && may_continue(); missing = missing_programs()) {
      const double waited_s = std::chrono::duration<double>(Clock::now() - begin).count();
      if (waited_s > options_.join_timeout_s)
        throw RunError(5, "timeout",
                       fmt::format("{} has not joined the lockstep on {} within {:g} s{}", missing, bus_.url(),
                                   options_.join_timeout_s,
                                   options_.await.empty() ? "; for programs that only listen: --join-timeout 0" : ""));
      if (!reported && waited_s > 1) {
        progress_.report(fmt::format("waiting for {} to join the lockstep on {}", missing, bus_.url()));
        reported = true;
      }
      execute();
      bus_.wait_for_message(milliseconds(20));
    }
  }

  void play_steps() {
    const std::int64_t last = last_step();
    if (last < world_.step_number())
      throw RunError(2, "configuration",
                     fmt::format("{}: begins at {:.6g} s, after --until", log_.path, sim::to_seconds(world_.now())));
    end_step();
    // Serve requests, wait for clients, keep the pace, step.
    while (may_continue() && world_.step_number() < last) {
      execute();
      if (!synchronized_) {
        synchronize();
        continue;
      }
      pace();
      if (!control_.may_step()) {
        progress_.update(world_.now(), played_, control_, true);
        bus_.wait_for_message(milliseconds(20));
        continue;
      }
      take_answers();
      world_.step();
      control_.step_taken();
      end_step();
      progress_.update(world_.now(), played_, control_, false);
    }
    // Wait for the answers to the last step.
    while (may_continue() && !synchronized_) {
      execute();
      synchronize();
    }
    if (synchronized_) take_answers();
  }

  /// Publishes the messages of the step, then the ticks.
  void end_step() {
    steps_.published_at(world_.step_number(), [this](std::string_view channel, std::span<const std::byte> payload) {
      publish(channel, payload);
    });
    gate_.end_of_step();
    synchronize();
  }

  void publish(std::string_view channel, std::span<const std::byte> payload) {
    gate_.publish(channel, payload, world_.now());
    ++played_;
  }

  void synchronize() {
    const auto outcome = lockstep_.synchronize([this](milliseconds time) { bus_.wait_for_message(time); },
                                               [this] {
                                                 execute();
                                                 if (control_.paused)
                                                   progress_.update(world_.now(), played_, control_, true);
                                                 return may_continue();
                                               });
    synchronized_ = outcome == bridges::LockstepOutcome::done;
  }

  /// Compares the messages of programs for this step, and publishes the recorded ones in their place.
  void take_answers() {
    answers_.came(world_.step_number(), gate_.admit());
    steps_.inputs_after(world_.step_number(), [this](std::string_view channel, std::span<const std::byte> payload) {
      // A program that publishes here does not receive the recorded messages, and no client receives both.
      if (!answers_.is_spoken(channel) || lockstep_.has_receiver(channel)) publish(channel, payload);
    });
    for (const auto& mailbox : mailboxes_)
      while (mailbox->take()) {
      }
  }

  void pace() {
    const sim::Time next = world_.now() + world_.step_time();
    for (auto wait = pacer_.until(next, control_); wait.count() > 0 && may_continue() && control_.may_step();
         wait = pacer_.until(next, control_)) {
      if (wait > milliseconds(2))
        bus_.wait_for_message(
            std::min(std::chrono::duration_cast<milliseconds>(wait) - milliseconds(1), milliseconds(20)));
      else
        std::this_thread::sleep_for(wait);
      execute();
    }
  }

  std::string where() {
    const std::string waits = lockstep_.waits_for();
    return fmt::format("step {}, {:.6g} s of {:.6g} s of a record{}{}", world_.step_number(),
                       sim::to_seconds(world_.now()), static_cast<double>(log_.last_step * log_.info.step_us) * 1e-6,
                       waits.empty() ? "" : ", ", waits);
  }

  PlayOutcome outcome(double wall_s) {
    PlayOutcome result;
    const std::int64_t steps = world_.step_number() - log_.begin_step();
    const double played_s = static_cast<double>(steps * log_.info.step_us) * 1e-6;
    result.text = fmt::format("played {:.3f} s ({} steps, {} messages) in {:.2f} s: {:.1f} times real time\n", played_s,
                              steps, played_, wall_s, wall_s > 0 ? played_s / wall_s : 0);
    for (const bridges::LockstepSummary& client : lockstep_.summaries())
      result.text += fmt::format("{}: {} ticks{}\n", sim::printable(client.client), client.ticks,
                                 client.ended.empty() ? "" : "; " + sim::printable(client.ended));
    for (const std::string& line : answers_.to_lines(sim::to_seconds(world_.step_time())))
      result.text += sim::printable(line) + "\n";
    for (const std::string& problem : log_.problems) result.text += "note: the log: " + problem + "\n";
    if (caught_signal() != 0)
      result.exit_code = 128 + caught_signal();
    else if (options_.compare && !answers_.all_equal())
      result.exit_code = 1;
    return result;
  }

  const PlayOptions& options_;
  ReplayLog log_;
  sim::LoadedWorld empty_;
  bridges::LcmBus bus_;
  bridges::OtherSimulators others_;
  sim::MessageGate gate_;
  sim::InProcessBus inner_;  // of the empty world, which publishes nothing
  sim::RunControl control_;
  sim::World world_;
  bridges::LockstepService lockstep_;
  bridges::SimService service_;
  PlayerRequests requests_;
  RecordedSteps steps_;
  PlayedAnswers answers_;
  std::vector<std::unique_ptr<sim::Mailbox>> mailboxes_;
  Progress progress_;
  Pacer pacer_;
  sim::Bytes buffer_;
  bool synchronized_ = false;
  std::uint64_t played_ = 0;
};

}  // namespace

PlayOutcome play(const PlayOptions& options) {
  return Player(options).run();
}

}  // namespace experiment
