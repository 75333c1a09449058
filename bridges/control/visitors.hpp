// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "shoal/sim_vehicle_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/world/world.hpp"

namespace sim {
struct SpawnRequest;
}

namespace bridges {

class RunJournal;

/// The vehicles that clients bring over `sim.control`, and whose they are.  Every vehicle that comes or goes, whoever
/// brings or takes it, is told on `sim.vehicle`.
class Visitors {
 public:
  /// `journal` is given every request that is about to change the world, whoever makes it, and descriptions; may be
  /// null.
  Visitors(sim::World& world, sim::Bus& bus, RunJournal* journal);

  /// Adds the vehicle that `text` describes (an entry of `vehicles:` in YAML); returns one line that names it, its
  /// channels and rates.  Throws sim::ConfigError, with the same lines as for files.
  std::string spawn(const std::string& client, const std::string& text);
  /// The same with a text that a journal wrote down.
  std::string spawn_again(const std::string& client, const std::string& text);
  /// A vehicle or an object.  Throws sim::WorldError.
  void remove(const std::string& client, const std::string& name);
  /// Says the same as spawn() did.  Throws sim::WorldError.
  std::string describe(const std::string& client, const std::string& vehicle);
  /// An action as in `events:`, in YAML.  Throws sim::ConfigError.
  void act(const std::string& client, const std::string& text);

  /// Tells of the vehicles that came or went since the last call.
  void tell_changes();
  /// After visit_state() restored: tells those who heard of the time before what came or went by that.  The world does
  /// not hear it, nor does its record: they know nothing of another time.
  void tell_others(sim::Bus& network);
  /// The client lives.
  void heard_of(const std::string& client);
  /// Removes the vehicles of clients that said nothing for their time-out (wall time).
  void remove_silent();
  /// Removes the vehicles that came with this client and go with it.
  void remove_those_of(const std::string& client);
  bool has(const std::string& client) const { return clients_.contains(client); }
  /// Whose vehicles there are.  When restoring, after the world itself, time-outs begin anew.
  void visit_state(sim::StateArchive& archive);

 private:
  using Clock = std::chrono::steady_clock;
  struct Client {
    Clock::time_point heard;
    std::chrono::duration<double> timeout{0};
    void visit_state(sim::StateArchive& archive);
  };
  struct Owner {
    std::string client;
    bool with_client = false;
    void visit_state(sim::StateArchive& archive);
  };

  using Known = std::map<std::string, shoal::sim_vehicle_t, std::less<>>;

  std::string add(const std::string& client, const sim::SpawnRequest& request);
  void know_all();
  void tell_difference(Known& known, sim::Bus& bus);
  void tell(sim::Bus& bus, shoal::sim_vehicle_t& message, bool present);
  void write_down(const std::string& client, const std::string& command, const std::string& text);

  sim::World& world_;
  sim::Bus& bus_;
  RunJournal* const journal_;
  std::map<std::string, Owner, std::less<>> owners_;    // by vehicle
  std::map<std::string, Client, std::less<>> clients_;  // those with vehicles that go with them
  Known known_;                                         // the vehicles told of, or there from the start
  std::optional<Known> told_others_;  // before time went elsewhere; unset: they know what the world does
  std::uint64_t generation_ = 0;
  sim::Bytes buffer_;
};

}  // namespace bridges
