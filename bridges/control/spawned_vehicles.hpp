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

/// Returns what `sim.vehicle` says of a vehicle: its devices, channels and rates; without time, owner and presence.
shoal::sim_vehicle_t vehicle_message(const sim::Vehicle& vehicle);

/// Vehicles that clients spawn over `sim.control`, and their owners.  Every vehicle that is added or removed, by any
/// client, is reported on `sim.vehicle`.
class SpawnedVehicles {
 public:
  /// `journal` records every request that is about to change the world, from any client, and descriptions; may be null.
  SpawnedVehicles(sim::World& world, sim::Bus& bus, RunJournal* journal);

  /// Adds the vehicle that `text` describes (an entry of `vehicles:` in YAML); returns one line that names it, its
  /// channels and rates.  Throws sim::ConfigError, with the same lines as for files.
  std::string spawn(const std::string& client, const std::string& text);
  /// Publishes the report of a spawned vehicle again on `network`, for a client that did not receive it; not recorded.
  /// `line`: what spawn() returned.
  void report_again(sim::Bus& network, const std::string& line);
  /// Spawns a vehicle from a text of a journal.
  std::string spawn_again(const std::string& client, const std::string& text);
  /// Removes a vehicle or an object.  Throws sim::WorldError.
  void remove(const std::string& client, const std::string& name);
  /// Returns the same text as spawn().  Throws sim::WorldError.
  std::string describe(const std::string& client, const std::string& vehicle);
  /// Executes an action as in `events:`, in YAML.  Throws sim::ConfigError.
  void act(const std::string& client, const std::string& text);

  /// Reports the vehicles that were added or removed since the last call.
  void report_changes();
  /// Reports vehicles that were added or removed by a restore with visit_state() to external programs.  The world and
  /// its record do not receive these reports, because they have only one timeline.
  void report_to_other_timeline(sim::Bus& network);
  /// Notes that the client is alive.
  void client_alive(const std::string& client);
  /// Removes the vehicles of clients that were silent longer than their time-out (wall time).  It does not run for
  /// those that take part in the lockstep, which has time-outs of its own.
  void remove_timed_out(const std::function<bool(const std::string& client)>& takes_part);
  /// Removes the vehicles that this client spawned with `with_client`.
  void remove_vehicles_of(const std::string& client);
  bool has(const std::string& client) const { return clients_.contains(client); }
  /// Visits the owners of the vehicles.  Must be restored after the world; restoring restarts the time-outs.
  void visit_state(sim::StateArchive& archive);

 private:
  using Clock = std::chrono::steady_clock;
  struct Client {
    Clock::time_point last_seen;
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
  void record_all();
  void report_difference(Known& known, sim::Bus& bus);
  void report(sim::Bus& bus, shoal::sim_vehicle_t& message, bool present);
  void write_down(const std::string& client, const std::string& command, const std::string& text);

  sim::World& world_;
  sim::Bus& bus_;
  RunJournal* const journal_;
  std::map<std::string, Owner, std::less<>> owners_;    // by vehicle
  std::map<std::string, Client, std::less<>> clients_;  // those with vehicles that are removed with them
  Known known_;                                         // the reported vehicles, or those present from the start
  std::optional<Known> known_to_others_;                // known before a rewind; unset: the same as for the world
  std::uint64_t generation_ = 0;
  sim::Bytes buffer_;
};

}  // namespace bridges
