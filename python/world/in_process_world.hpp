// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "python/world/world_channels.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"

namespace python {

/// Options of a world that is loaded by a program.
struct WorldSource {
  std::string file;                  ///< path of the world; of a text: its name in errors
  std::optional<std::string> text;   ///< YAML instead of the file
  std::vector<std::string> sets;     ///< as with --set
  std::optional<std::int64_t> seed;  ///< instead of that of the file
};

/// Reads a world.  Throws sim::ConfigError.
std::shared_ptr<const sim::LoadedWorld> load(const WorldSource& source, sim::Warnings* warnings = nullptr);

/// World that the calling program steps, with a bus inside the process.  Its hashes are those of `shoal run`.
class InProcessWorld {
 public:
  /// Called every few milliseconds during long work; true: the work ends.
  using Stop = std::function<bool()>;

  explicit InProcessWorld(std::shared_ptr<const sim::LoadedWorld> loaded);

  sim::World& world() { return world_; }
  const sim::World& world() const { return world_; }
  LastMessages& bus() { return bus_; }
  const std::shared_ptr<const sim::LoadedWorld>& loaded() const { return loaded_; }

  /// Takes up to `count` steps; fewer when the world ends the run or `stop` returns true.  Returns the steps taken.
  /// Throws sim::PhysicsFault; the world then cannot be stepped further, but restored.
  std::int64_t step(std::int64_t count, const Stop& stop = {});
  /// Publishes a payload as a program would; devices get it in the next step.  On a channel without a reader it warns
  /// once.  Throws sim::WorldError for a channel whose name is close to that of one that has a reader, and
  /// shoal::MessageError for a payload that is not valid, or that the device of the channel refuses.
  void publish(const std::string& channel, std::span<const std::byte> payload);
  /// Publishes a payload that needs no check.
  void send(const std::string& channel, std::span<const std::byte> payload) {
    world_.bus_of_channel(channel).publish(channel, payload, world_.now());
  }
  /// Returns the last payload of a channel; null before the first.  For a channel that is not in the world it warns
  /// once, or throws sim::WorldError when its name is close to that of another.
  const sim::Bytes* last(const std::string& channel);
  /// Opens a mailbox; see last().
  std::shared_ptr<sim::Mailbox> subscribe(const std::string& channel, std::size_t capacity);
  /// Returns the channels of the entities that are in the world now.
  const WorldChannels& channels();
  /// Executes an action, or a list of them, written in YAML, as in `events:`.  Throws sim::ConfigError,
  /// sim::WorldError.
  void act(const std::string& action);
  /// Adds the vehicles of an entry of `vehicles:`, written in YAML; returns their names.  Throws sim::ConfigError.
  std::vector<std::string> spawn(const std::string& entry);

  /// Removes a vehicle or an object.  Throws sim::WorldError.
  void remove(const std::string& name);

  sim::Bytes snapshot() const { return world_.state().snapshot(); }
  /// Restores a snapshot of the same world.  Throws sim::SnapshotError.
  void restore(std::span<const std::byte> snapshot);
  /// Returns another world in the same state.
  std::unique_ptr<InProcessWorld> branch() const;

 private:
  void require_readable(const std::string& channel);

  const std::shared_ptr<const sim::LoadedWorld> loaded_;
  LastMessages bus_;
  sim::World world_;
  std::optional<WorldChannels> channels_;
  std::uint64_t generation_ = 0;                   // of channels_
  std::set<std::string, std::less<>> known_;       // channels on which something was published, or that were reported
  std::set<std::string, std::less<>> subscribed_;  // channels that the program reads
  std::string fault_;                              // of a step that failed; empty: none
  std::vector<std::weak_ptr<sim::Mailbox>> mailboxes_;  // of the program
};

/// True motion of a vehicle, in the layout of the NumPy type that World.states() returns.
struct Motion {
  double position_m[3];    ///< in world axes
  double orientation[4];   ///< w x y z, from vehicle to world axes, w >= 0
  double velocity_mps[3];  ///< of the origin of the vehicle, in world axes
  double rates_radps[3];   ///< angular velocity in vehicle axes
};

Motion motion_of(const sim::Vehicle& vehicle);

}  // namespace python
