// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

#include "sim/bus/bus.hpp"
#include "sim/vehicle/run_hash.hpp"

namespace sim {

/// Function that returns the bus of a name.
using BusFinder = std::function<Bus&(const std::string& name)>;

/// Buses of a world, each included in its run hash, and the channels of its devices on them.
class WorldBuses {
 public:
  /// `find` returns the bus of a name; without it all vehicles are on `bus`, which must outlive this.
  WorldBuses(Bus& bus, BusFinder find) : bus_(bus), find_(std::move(find)) {}

  /// Returns the bus of the world.
  Bus& own() { return run_hash_.counted(bus_); }
  /// Returns a bus by name; empty: the bus of the world.
  Bus& named(const std::string& name) { return name.empty() || !find_ ? own() : run_hash_.counted(find_(name)); }
  /// Returns the bus of a channel: that of the vehicle whose device uses it, else that of the world.
  Bus& of_channel(const std::string& channel) {
    const auto known = channels_.find(channel);
    return known == channels_.end() ? own() : *known->second;
  }

  bool taken(const std::string& channel) const { return channels_.contains(channel); }
  void take(const std::string& channel, Bus& bus) { channels_.emplace(channel, &bus); }
  void release(const std::string& channel) { channels_.erase(channel); }
  void release_all() { channels_.clear(); }
  RunHash& run_hash() { return run_hash_; }

 private:
  Bus& bus_;
  BusFinder find_;
  RunHash run_hash_;
  std::map<std::string, Bus*, std::less<>> channels_;  // those of devices
};

}  // namespace sim
