// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiment/replay/replay_log.hpp"
#include "experiment/replay/replay_ports.hpp"
#include "experiment/run/run_parts.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// World of a log that is run again: the recorded inputs are delivered at the same steps as in the run.  A log of
/// several branches gives the last one.
///
/// With `for_programs` it has the LCM buses of its world, muted at first.  Programs that take part on them get the
/// reports of the repeated steps; what they publish counts after set_live() only.
class ReplayedWorld {
 public:
  /// Receives a message that the world publishes.
  using Watch = std::function<void(std::string_view channel, std::span<const std::byte> payload)>;
  struct Options {
    std::string world;      ///< another world file; empty: the world in the log
    sim::LoadOptions load;  ///< its `sets` are applied to the world
    int threads = 0;        ///< threads that share a step; 0: one for each processor
    Watch inputs = {};      ///< receives the recorded messages that are delivered
    /// LCM URL of the bus of the world for programs, empty: LCM_DEFAULT_URL, then the default; unset: the buses have no
    /// other participants.  The arguments of its programs are then read.
    std::optional<std::string> for_programs = {};
  };

  /// Builds the world at the start of the log.  `log` must outlive this.  Throws std::runtime_error when the log cannot
  /// be replayed, sim::ConfigError when the world cannot be built, bridges::BusError.
  ReplayedWorld(const ReplayLog& log, const Options& options, Watch watch = {});

  sim::World& world() { return parts_.world; }
  const sim::World& world() const { return parts_.world; }
  const sim::LoadedWorld& loaded() const { return loaded_; }
  /// Bus of the world; what is published on it goes to the watch.
  sim::Bus& bus() { return parts_.buses.outer(); }
  RunParts& parts() { return parts_; }
  const RunParts& parts() const { return parts_; }

  /// Delivers the inputs before the first reports and publishes them.  To be called once, before step().
  void start();
  /// Delivers the inputs of the next step and runs it.  Throws sim::PhysicsFault.
  void step();
  /// Executes the requests after the last step.
  void finish() { deliver(world().step_number()); }
  /// Executes a request that is not in the log, and returns the reply.  Throws std::runtime_error with the reason when
  /// it is refused.
  std::string request(const shoal::sim_control_request_t& request) {
    return parts_.service.execute_local(request, nullptr);
  }
  /// Delivers the inputs from the present step on again; to be called after the state was set to an earlier one.
  void repeat_inputs();
  /// Returns whether the record has messages of programs.
  bool has_commands() const;
  /// Drops the inputs at this step and later, for a branch whose programs publish in their place.
  void drop_inputs_from(std::int64_t step);
  /// Takes all inputs of the record again, and forgets those of the branch.
  void restore_inputs();
  /// Sets whether messages and requests from outside count.  They are kept with the inputs of the record, so that they
  /// are delivered again after repeat_inputs().
  void set_live(bool live) { live_ = live; }
  /// Returns what could not be delivered.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  RunParts::Options parts_options();
  void check_times() const;
  void add_serial_inputs(std::int64_t from_step);
  /// Restores the snapshot with which the run, or the branch, started.
  void restore(bool same_world);
  /// Delivers the inputs of the world before this step.
  void deliver(std::int64_t step);
  void deliver(const ReplayLog::Input& input);
  void admit(const std::string& bus, int link);
  void execute(const ReplayLog::Input& input);
  void note(const std::string& text);

  const ReplayLog& log_;
  sim::LoadedWorld loaded_;
  Watch watch_, inputs_;
  const bool for_programs_;
  ReplayPorts serial_;
  sim::InProcessBus unread_;  // of the journal, which tells the requests of programs
  RunParts parts_;
  std::size_t next_input_ = 0, next_own_ = 0;
  std::int64_t end_of_inputs_ = std::numeric_limits<std::int64_t>::max();  // later ones of the record are dropped
  std::vector<ReplayLog::Input> own_inputs_;                               // since then, while live
  std::map<std::string, std::vector<sim::MessageGate::Delivery>> due_;     // inputs of the next step, by bus
  std::set<std::pair<int, std::string>> spoken_;  // links and channels on which programs publish
  bool live_ = false;
  std::vector<std::string> notes_;
};

/// Returns the lines that differ between two texts, in order: `-` before lines only in the first, `+` before lines only
/// in the second, with the line number.  At most `max` lines, followed by the number of the remaining ones.
std::vector<std::string> line_difference(const std::string& first, const std::string& second, std::size_t max = 40);

/// Returns the entities that only the first world has, by name: `object 'box'`, `vehicle 'r1'`, `device 'r1/lidar'`,
/// `event 'storm'`.
std::vector<std::string> entities_only_in(const sim::WorldConfig& world, const sim::WorldConfig& other);

}  // namespace experiment
