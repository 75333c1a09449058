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
#include "bridges/lockstep/lockstep_service.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// Interface that executes requests about simulated time: speed, pause, rewind and restore.
class TimeMachine {
 public:
  virtual ~TimeMachine() = default;
  /// Returns the result of a request; none when the command is unknown.  Throws std::runtime_error with the reason when
  /// it is refused.
  virtual std::optional<std::string> execute(const std::string& command, const std::string& text, double value) = 0;
};

/// Optional objects used by a service; all must outlive it.
struct ServiceLinks {
  RunJournal* journal = nullptr;            ///< records the requests that change the world
  const OtherSimulators* others = nullptr;  ///< check for other simulators, which are warned of once
  /// Buses of single vehicles, on which the service only publishes sim.clock and answers join, leave and alive on
  /// sim.control.  In the order of the lockstep.
  std::vector<sim::Bus*> vehicle_buses = {};
  std::function<void()> publish_scene = {};  ///< publishes the scene for viewers again; empty: there is none
  /// Returns the LCM URL of the bus of a vehicle; empty when it is not an LCM bus.
  std::function<std::string(sim::Bus&)> bus_url = {};
};

/// Service on the channels of the simulator: publishes sim.info, sim.clock and sim.state, and answers requests on
/// sim.control.  Works with any Bus.
class SimService {
 public:
  struct Info {
    std::string resolved_config;
    std::string versions;
    std::string build = {};  ///< see sim_info_t
    std::string files = {};
  };

  /// `network`: the bus behind `bus`; the handshake uses it directly, so that records exclude it.
  SimService(sim::Bus& bus, sim::Bus& network, sim::World& world, sim::RunControl& control, LockstepService& lockstep,
             Info info, const ServiceLinks& links = {});

  /// Visits the owners of the vehicles.
  void visit_state(sim::StateArchive& archive) { spawned_vehicles_.visit_state(archive); }
  /// Mutes the service: while muted, it publishes only on the bus of the world.
  void set_muted(bool muted) { muted_ = muted; }
  /// Sets whether the steps of a record are repeated: then the record removes the vehicles of clients that are silent.
  void set_repeating(bool repeating) { repeating_ = repeating; }
  /// Reports vehicles that were added or removed by a rewind; not recorded, because the record has only one timeline.
  void report_changes() { spawned_vehicles_.report_to_other_timeline(network_); }
  /// Publishes sim.info immediately, and not again at this step.
  void publish_info();
  /// Executes a request from a journal.  Throws std::runtime_error with the reason when it is refused, as in the
  /// original run.
  void execute_again(const shoal::sim_control_request_t& request);
  /// Publishes the messages due after the present step of the world: clock, state, info.
  void publish_step();
  /// Answers the requests that have arrived.  `machine` executes those about simulated time: pause, resume, step,
  /// speed, until, where, snapshot, restore and rewind; null: not supported.
  void handle_requests(TimeMachine* machine = nullptr);
  /// Executes a request of a user at this process, such as of the live page, as one on sim.control, and returns the
  /// reply.  Throws std::runtime_error with the reason when it is refused.
  std::string execute_local(const shoal::sim_control_request_t& request, TimeMachine* machine);
  /// Handles the exit of a client: it leaves the lockstep, and its vehicles are removed.
  void client_exited(const std::string& client);

  /// Returns the client that the world waits for; empty: none.
  std::string waits_for() { return lockstep_.waits_for(); }
  /// Returns the number of bad requests.
  std::int64_t bad_messages() const { return bad_messages_; }
  /// Returns the number of requests refused because they were not signed with the key of the run.
  std::int64_t refused_requests() const { return refused_requests_; }
  /// Returns the audit: clients that made the run end, rewind, or lose data.
  const RunAudit& audit() const { return audit_; }

 private:
  /// Bus on which clients may be.
  struct Link {
    sim::Bus* network;
    std::unique_ptr<sim::Mailbox> requests;
    std::unique_ptr<sim::Mailbox> infos;  ///< sim.info of another simulator that was not found at the start
  };

  void publish_state();
  bool handle_request(Link& link, const sim::Message& message, TimeMachine* machine);
  void answer_in_turn(int max_at_once, TimeMachine* machine);
  void wait_for_turn(Link& link, const shoal::sim_control_request_t& request, const std::string& signer);
  void refuse(Link& link, const shoal::sim_control_request_t& request, const ControlGuard::Opened& opened);
  void answer(Link& link, const shoal::sim_control_request_t& request, const std::string& signer, TimeMachine* machine);
  void reply(Link& link, const shoal::sim_control_request_t& request, std::int64_t session, bool ok,
             const std::string& text);
  /// Stores an answer for repetitions of its request, if they would wait for their turn.
  void note_answer(const Link& link, const shoal::sim_control_request_t& request, bool ok, const std::string& text);
  /// Executes a request and returns the result; none while it is undecided and not answered yet.  Throws
  /// std::runtime_error with the reason when it is refused.
  std::optional<std::string> execute(Link& link, const shoal::sim_control_request_t& request, TimeMachine* machine);
  /// Returns the LCM URL of the bus of a vehicle.
  std::string url_of(const std::string& vehicle) const;
  /// Returns the quota of a command; null when it is unlimited.
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
  bool muted_ = false, repeating_ = false;
  std::int64_t info_step_ = -1;  // step of the last sim.info
  const OtherSimulators* const others_;
  const std::function<void()> publish_scene_;
  const std::function<std::string(sim::Bus&)> bus_url_;
  bool warned_of_another_ = false;
  std::vector<Link> links_;  // the bus of the world is the first
  RunAudit audit_;
  ClientAccounts spawns_, rewinds_;
  std::set<std::string, std::less<>> warned_refused_;  // clients
  std::int64_t refused_requests_ = 0;
  std::chrono::steady_clock::time_point refusals_since_;
  int refusals_answered_ = 0;  // since then
  std::int32_t branch_of_requests_ = 0;
  sim::Bytes buffer_;
  std::int64_t bad_messages_ = 0;
};

}  // namespace bridges
