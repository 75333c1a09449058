// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bridges/control/client_accounts.hpp"
#include "bridges/control/other_simulators.hpp"
#include "bridges/control/run_audit.hpp"
#include "bridges/control/spawned_vehicles.hpp"
#include "bridges/control/time_machine.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// What a service works with where it is there; all must outlive the service.
struct ServiceLinks {
  RunJournal* journal = nullptr;            ///< what changes the world is written down there
  const OtherSimulators* others = nullptr;  ///< check for other simulators, which are warned of once
  /// Buses that vehicles have to themselves: there the service only publishes sim.clock and answers join, leave and
  /// alive on sim.control.  In the order in which the lockstep knows them.
  std::vector<sim::Bus*> vehicle_buses = {};
};

/// The simulator's own channels: publishes sim.info, sim.clock and sim.state, and answers requests on sim.control.
/// Speaks through any Bus.
class SimService {
 public:
  struct Info {
    std::string resolved_config;
    std::string versions;
    std::string build = {};  ///< see sim_info_t
    std::string files = {};
  };

  /// `network`: the bus under `bus`; the handshake goes there directly, so that records leave it out.
  SimService(sim::Bus& bus, sim::Bus& network, sim::World& world, sim::RunControl& control, LockstepService& lockstep,
             Info info, const ServiceLinks& links = {});

  /// The owners of the vehicles.
  void visit_state(sim::StateArchive& archive) { spawned_vehicles_.visit_state(archive); }
  /// While muted only the world's bus is published on.
  void set_muted(bool muted) { muted_ = muted; }
  /// Reports vehicles that were added or removed by a rewind; not recorded, as the record has one timeline only.
  void report_changes() { spawned_vehicles_.report_to_other_timeline(network_); }
  /// Publishes sim.info now, and not a second time at this step.
  void publish_info();
  /// Carries out a request that a journal wrote down.  Throws std::runtime_error that says why it was refused, as then.
  void execute_again(const shoal::sim_control_request_t& request);
  /// Publishes what is due after the world's current step: clock, state, info.
  void publish_step();
  /// Answers the requests that have come.  `machine` serves what is about time: pause, resume, step, speed, until,
  /// where, snapshot, restore and rewind; null: not supported.
  void handle_requests(TimeMachine* machine = nullptr);
  /// Handles the exit of a client: it leaves the lockstep, and its vehicles are removed.
  void client_exited(const std::string& client);

  /// Client that the world waits for; empty: none.
  std::string waits_for() { return lockstep_.waits_for(); }
  /// Bad requests so far.
  std::int64_t bad_messages() const { return bad_messages_; }
  /// Requests so far that were refused as they were not signed with the key of the run.
  std::int64_t refused_requests() const { return refused_requests_; }
  /// Clients that made the run end, rewind, or lose something.
  const RunAudit& audit() const { return audit_; }

 private:
  /// Where clients may be.
  struct Link {
    sim::Bus* network;
    std::unique_ptr<sim::Mailbox> requests;
    std::unique_ptr<sim::Mailbox> infos;  ///< of another simulator that was not found at the start
  };

  void publish_state();
  void handle_request(Link& link, const sim::Message& message, TimeMachine* machine);
  void refuse(Link& link, const shoal::sim_control_request_t& request, const ControlGuard::Opened& opened);
  void answer(Link& link, const shoal::sim_control_request_t& request, const std::string& signer, TimeMachine* machine);
  void reply(Link& link, const shoal::sim_control_request_t& request, std::int64_t session, bool ok,
             const std::string& text);
  /// The result; nothing: undecided, so there is no answer yet.  Throws std::runtime_error that says why it was
  /// refused.
  std::optional<std::string> execute(Link& link, const shoal::sim_control_request_t& request, TimeMachine* machine);
  /// What limits how often a client may request this; null: nothing does.
  ClientAccounts* account_for(const std::string& command);
  bool releases_another(const shoal::sim_control_request_t& request) const;
  void note(const shoal::sim_control_request_t& request, const std::string& signer);
  int number_of(const Link& link) const { return static_cast<int>(&link - links_.data()); }
  bool is_own_request(Link& link, const shoal::sim_control_request_t& request);
  void warn_of_another(const Link& link, const char* how);
  bool leave(int link, const shoal::sim_control_request_t& request);
  void open_link(sim::Bus& network);
  void warn_client(const std::string& text);
  bool due(double rate_hz) const;
  template <typename Message>
  void publish(sim::Bus& bus, const std::string& channel, const Message& message);

  sim::Bus& bus_;
  sim::Bus& network_;
  sim::World& world_;
  sim::RunControl& control_;
  LockstepService& lockstep_;
  Info info_;
  SpawnedVehicles spawned_vehicles_;
  RunJournal* const journal_;
  bool muted_ = false;
  std::int64_t info_step_ = -1;  // of the last sim.info
  const OtherSimulators* const others_;
  bool warned_of_another_ = false;
  std::vector<Link> links_;  // the world's first
  RunAudit audit_;
  ClientAccounts spawns_, rewinds_;
  std::set<std::string, std::less<>> warned_refused_;  // clients
  std::int64_t refused_requests_ = 0;
  std::chrono::steady_clock::time_point refusals_since_;
  int refusals_answered_ = 0;  // since then
  sim::Bytes buffer_;
  std::int64_t bad_messages_ = 0;
};

}  // namespace bridges
