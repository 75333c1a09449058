// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/experiment/replay/replay_log.hpp"
#include "tools/experiment/replay/replay_ports.hpp"

namespace tools {

/// World of a log that is run again, without clients: the recorded inputs are delivered at the same steps as in the
/// run.  A log of several branches gives the last one.
class ReplayedWorld {
 public:
  /// Receives a message that the world publishes.
  using Watch = std::function<void(std::string_view channel, std::span<const std::byte> payload)>;
  struct Options {
    std::string world;      ///< another world file; empty: the world in the log
    sim::LoadOptions load;  ///< its `sets` are applied to the world
    int threads = 0;        ///< threads for ray casting; 0: one for each processor
    Watch inputs = {};      ///< receives the recorded messages that are delivered
  };

  /// Builds the world at the start of the log.  `log` must outlive this.  Throws std::runtime_error when the log cannot
  /// be replayed, sim::ConfigError when the world cannot be built.
  ReplayedWorld(const ReplayLog& log, const Options& options, Watch watch = {});

  sim::World& world() { return world_; }
  const sim::World& world() const { return world_; }
  const sim::LoadedWorld& loaded() const { return loaded_; }
  /// Bus of the world; what is published on it goes to the watch.
  sim::Bus& bus() { return *main_.gate; }

  /// Delivers the inputs before the first reports and publishes them.  To be called once, before step().
  void start();
  /// Delivers the inputs of the next step and runs it.  Throws sim::PhysicsFault.
  void step();
  /// Executes the requests after the last step.
  void finish() { deliver(world_.step_number()); }
  /// Executes a request that is not in the log, and returns the reply.  Throws std::runtime_error with the reason when
  /// it is refused.
  std::string request(const shoal::sim_control_request_t& request) { return service_.execute_local(request, nullptr); }
  /// Saves the present state, and goes back to one that was saved; the inputs since then are delivered again.  Throws
  /// sim::SnapshotError.
  sim::Bytes save();
  void load(const sim::Bytes& saved);
  /// Returns what could not be delivered.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// Bus without other participants.
  struct Line {
    std::unique_ptr<sim::InProcessBus> network = std::make_unique<sim::InProcessBus>();
    std::unique_ptr<sim::MessageGate> gate = std::make_unique<sim::MessageGate>(*network);
  };

  Line make_line();
  std::map<std::string, Line> make_others();
  void check_times() const;
  void add_serial_inputs(std::int64_t from_step);
  /// Restores the snapshot with which the run, or the branch, started.
  void restore(bool same_world);
  /// Delivers the inputs of the world before this step.
  void deliver(std::int64_t step);
  void execute(const ReplayLog::Input& input);
  void note(const std::string& text);

  const ReplayLog& log_;
  sim::LoadedWorld loaded_;
  Watch watch_, inputs_;
  ReplayPorts serial_;
  Line main_;
  std::map<std::string, Line> others_;
  sim::RunControl control_;
  sim::World world_;
  bridges::LockstepService lockstep_{world_, control_};  // no client joins
  bridges::SimService service_;
  std::size_t next_input_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace tools
