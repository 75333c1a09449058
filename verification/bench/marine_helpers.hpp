// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verification/bench/bench_scene.hpp"

namespace verification {

/// Fleet of one kind in deep water.
struct MarineFleet {
  std::string name;  ///< of the world
  double step_s;
  std::string vehicle;              ///< `file: ...` or `model: {...}`
  std::string more_of_medium = "";  ///< further keys of `medium:`, such as `waves: {...}`
  double depth_m = 20;
  double spacing_m = 5;      ///< of the grid of vehicles
  std::string objects = "";  ///< section `objects:`, with its line end
};

/// Returns the world file: water with a constant current of (0.2, 0.1, 0) m/s, vehicles in a grid.
std::string marine_fleet_text(const MarineFleet& fleet, int vehicles);

/// Publishes commands once, before the first step.
class StartCommands final : public ScenePrograms {
 public:
  /// `command`: called for each vehicle, with its index from 0.
  using Command = std::function<void(const sim::Vehicle& vehicle, int index, sim::Bus& bus)>;
  StartCommands(const sim::World& world, sim::Bus& bus, Command command)
      : world_(world), bus_(bus), command_(std::move(command)) {}
  void think(sim::Time now) override;

 private:
  const sim::World& world_;
  sim::Bus& bus_;
  Command command_;
  bool sent_ = false;
};

/// Sets propeller, rudder and stern planes of a REMUS to a speed around 2 m/s and a wide turn, by its index.
void set_off_remus(const sim::Vehicle& vehicle, int index, sim::Bus& bus);
/// Sets both propellers of an Otter, by its index.
void set_off_otter(const sim::Vehicle& vehicle, int index, sim::Bus& bus);
/// Gives the autopilot of a vehicle a speed, a heading and a depth by its index.
void set_off_autopilot(const sim::Vehicle& vehicle, int index, sim::Bus& bus);

/// Sends 32 bytes by the acoustic modem of each vehicle that has one, every 10 s; of N modems number k at k / N of the
/// period, so that messages overlap at the receivers.
class Talkers final : public ScenePrograms {
 public:
  Talkers(const sim::World& world, sim::Bus& bus);
  void think(sim::Time now) override;

 private:
  sim::Bus& bus_;
  std::vector<std::string> channels_;
  sim::Bytes payload_;
  std::int64_t next_ = 0;  ///< number of the next message
};

}  // namespace verification
