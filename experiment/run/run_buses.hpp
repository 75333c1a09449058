// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/control/other_simulators.hpp"
#include "bridges/log/recording_bus.hpp"
#include "experiment/run/mute_bus.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/tap_bus.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/world_file/world_config.hpp"

namespace experiment {

/// Buses of a run: that of the world, and those of single vehicles.  With a record, all are written into one log.
class RunBuses {
 public:
  /// What a tap receives of what the simulation publishes.
  enum class Tap {
    sent,       ///< nothing while the buses are muted
    published,  ///< everything
  };
  /// `tap`: receives what the simulation publishes on any bus; empty: none.  Throws BusError.
  RunBuses(const sim::WorldConfig& world, const RunOptions& options, const TapBus::Listener& tap = {},
           Tap taps = Tap::sent);

  /// The world's bus, recorded, behind its gate.
  sim::Bus& outer() { return main_.outer(); }
  /// The world's bus without the record.
  sim::Bus& network(const std::string& name = {}) { return name.empty() ? *main_.network : *others_.at(name).network; }
  /// The bus with a name in `buses:`, recorded, behind its gate; empty: the world's.
  sim::Bus& of(const std::string& name) { return name.empty() ? main_.outer() : others_.at(name).outer(); }
  /// The gate of a bus; empty: the world's.
  sim::MessageGate& gate(const std::string& name = {}) { return name.empty() ? *main_.gate : *others_.at(name).gate; }
  /// Delivers, at the start of a step, the messages that have arrived on every bus, the world's first, then by name,
  /// and passes them to `admitted`.
  using Admitted = std::function<void(const std::string& bus, std::span<const sim::MessageGate::Delivery> inputs)>;
  void admit(const Admitted& admitted);

  bool over_lcm() const { return main_.lcm != nullptr; }
  /// Returns whether a network, a record or a tap receives what is published.
  bool has_listeners() const { return over_lcm() || main_.recorder || main_.tap; }
  /// Returns whether the world has a bus of this name; empty: its own.
  bool has(const std::string& name) const { return name.empty() || others_.contains(name); }
  /// Returns whether messages of other machines can arrive on any bus.
  bool leave_machine() const;
  /// Returns the LCM URL of a bus; empty when it is not an LCM bus.
  std::string url(const std::string& name) const;
  /// Returns the name in `buses:` of a bus that of() returns, or of a vehicle on it; empty: the world's.
  std::string name_of(sim::Bus& bus) const;
  /// Returns the LCM buses, without record and gate.
  std::vector<bridges::OtherSimulators::BusToAsk> networks() const;
  /// Waits for a message on any bus, up to `time`.
  void wait(std::chrono::milliseconds time);
  void end_of_step();
  /// Sets the step that starts now, for the time stamps of the record.
  void set_time(sim::Time at);
  /// Returns the error of a connection or of the record.
  std::optional<std::string> lost_connection() const;
  std::optional<std::string> record_error() const;
  /// Returns the number of messages that the budget of the record left out.
  std::uint64_t left_out_of_record() const { return main_.recorder ? main_.recorder->left_out() : 0; }
  void close_record();
  /// Flushes the record, for a run that is paused.
  void hand_over_record();
  /// Position in the record.
  struct RecordMark {
    std::uint64_t events = 0, position = 0;
  };
  RecordMark record_mark() const;
  /// Prepares another record, which starts with the present one's up to a mark.  Throws BusError.
  void prepare_record(const std::string& path, const RecordMark& mark, bool overwrite);
  /// Continues with the prepared record, or removes it.
  void branch_record();
  void give_up_record();
  /// Mutes all buses: nothing is sent to the networks or recorded, and incoming messages are discarded.  Both calls
  /// discard the messages that wait at the gates.
  void set_muted(bool muted);
  /// Returns the counts of all buses.
  sim::BusCounts counts() const;

 private:
  struct Link {
    std::unique_ptr<sim::Bus> network;
    bridges::LcmBus* lcm = nullptr;  ///< the same, when it is LCM
    std::unique_ptr<bridges::RecordingBus> recorder;
    std::unique_ptr<TapBus> tap;  ///< null: none
    std::unique_ptr<MuteBus> mute;
    std::unique_ptr<sim::MessageGate> gate;
    sim::Bus& outer() { return *gate; }
    void close_gate(const TapBus::Listener& listener, Tap taps);
  };
  Link open(const std::string& url, const RunOptions& options);
  template <typename Use>
  void for_each(Use&& use) const {
    use(main_);
    for (const auto& [name, link] : others_) use(link);
  }

  std::shared_ptr<bridges::Arrivals> arrivals_ = std::make_shared<bridges::Arrivals>();
  bool muted_ = false;
  Link main_;
  std::map<std::string, Link, std::less<>> others_;  // destroyed before the main one, whose log they write
};

}  // namespace experiment
