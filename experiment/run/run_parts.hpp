// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bridges/control/other_simulators.hpp"
#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "bridges/log/run_journal.hpp"
#include "experiment/run/run_buses.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/tap_bus.hpp"
#include "sim/bus/byte_port.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// A world, its buses, and what serves programs on them: journal, lockstep and control.  A run, a record that is run
/// again and an imported record are made of these parts, and differ in what moves the world and what it publishes to.
///
/// The order of the members is that of their construction: the buses ask for other simulators while the world is built,
/// the world opens its serial ports through those of the journal, and the service answers for the lockstep.
struct RunParts {
  struct Options {
    std::string files;                         ///< hashes of the files that the world names
    TapBus::Listener tap = {};                 ///< receives what is published on any bus; empty: nothing does
    RunBuses::Tap taps = RunBuses::Tap::sent;  ///< what the tap receives
    sim::PortOpener ports = {};                ///< of serial ports whose input is not recorded; empty: those of the run
    sim::Bus* journal = nullptr;               ///< bus of a journal without hashes; null: that of the world
    bool has_clients = true;                   ///< programs may take part, and requests are in the journal
    std::function<void()> publish_scene = {};  ///< publishes the scene for viewers again; empty: there is none
  };

  /// `loaded` and the bus of the journal must outlive this.  Throws ConfigError, BusError.
  RunParts(const sim::LoadedWorld& loaded, const RunOptions& run, const Options& options);
  RunParts(const RunParts&) = delete;
  RunParts& operator=(const RunParts&) = delete;

  RunBuses buses;
  bridges::OtherSimulators other_simulators;
  sim::RunControl control;
  bridges::JournalPorts ports;
  sim::World world;
  bridges::RunJournal journal;
  bridges::LockstepService lockstep;
  bridges::SimService service;

 private:
  std::vector<bridges::LockstepBus> lockstep_buses(const RunOptions& run, const Options& options);
  bridges::ServiceLinks service_links(const Options& options);
};

}  // namespace experiment
