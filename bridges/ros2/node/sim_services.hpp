// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bridges/ros2/cdr.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_state_t.hpp"

namespace bridges::ros2 {

/// Services of the package simulation_interfaces 2.1, which become requests on `sim.control`.  Requests and responses
/// begin with the 16 bytes by which rmw_cyclonedds matches them: identity of the client, and number of the call.
class SimServices {
 public:
  using Clock = std::chrono::steady_clock;
  /// Codes of simulation_interfaces/msg/Result, and those of single services.
  enum Code : std::uint8_t {
    unsupported = 0,
    ok = 1,
    not_found = 2,
    incorrect_state = 3,
    failed = 4,
    already_there = 101,
    incorrect_transition = 103,
    no_format = 103,
    bad_namespace = 105,
    bad_pose = 109
  };
  /// Name below that of the node, and type, such as `step_simulation`, `simulation_interfaces/srv/StepSimulation`.
  struct Service {
    const char* name;
    const char* type;
    bool changes;  ///< the run
    void (SimServices::*call)(CdrReader& request, std::uint32_t call);
    void (*rest)(CdrWriter& response);  ///< appends what follows the result, empty; null: nothing does
  };
  struct Links {
    /// Sends a request to the simulator, and returns its number.
    std::function<std::int32_t(const std::string& command, double value, const std::string& text)> ask;
    /// Sends a response of the service with this index.
    std::function<void(std::size_t service, std::span<const std::byte> cdr)> respond;
  };

  /// Longest wait for the simulator, and the most calls that wait; further ones fail.
  static constexpr std::chrono::seconds patience{10};
  static constexpr std::size_t max_calls = 64;

  /// `controls`: whether services that change the run are carried out, or refused.
  SimServices(Links links, bool controls) : links_(std::move(links)), controls_(controls) {}
  static std::span<const Service> services();

  /// Takes the state of the vehicles.
  void know(shoal::sim_state_t state) { state_ = std::move(state); }
  /// Takes a call of a service.  Throws shoal::MessageError for bytes that are not of its type.
  void call(std::size_t service, std::span<const std::byte> request, Clock::time_point now);
  /// Takes a reply of the simulator; replies to others are ignored.
  void take_reply(const shoal::sim_control_reply_t& reply, Clock::time_point now);
  /// Ends the calls that waited too long.
  void expire(Clock::time_point now);

 private:
  using Then = std::function<void(const shoal::sim_control_reply_t&)>;
  struct Call {
    std::size_t service = 0;
    std::uint64_t client = 0;
    std::int64_t number = 0;
  };
  struct Pending {
    std::uint32_t call = 0;
    Then then;
    Clock::time_point until;
  };

  void ask(std::uint32_t call, const std::string& command, double value, const std::string& text, Then then);
  /// Sends the response of a call, and forgets it.
  void respond(std::uint32_t call, std::uint8_t code, const std::string& error,
               const std::function<void(CdrWriter&)>& rest = {});
  /// Returns a continuation that responds with what the simulator replied.
  Then finish(std::uint32_t call);
  void await_step(std::uint32_t call, std::int64_t step);
  bool refuse_filters(CdrReader& request, std::uint32_t call);
  std::size_t find(const std::string& entity) const;
  void put_state(CdrWriter& out, std::size_t vehicle) const;

  void get_simulation_state(CdrReader& request, std::uint32_t call);
  void set_simulation_state(CdrReader& request, std::uint32_t call);
  void step_simulation(CdrReader& request, std::uint32_t call);
  void reset_simulation(CdrReader& request, std::uint32_t call);
  void get_entities(CdrReader& request, std::uint32_t call);
  void get_entity_state(CdrReader& request, std::uint32_t call);
  void get_entities_states(CdrReader& request, std::uint32_t call);
  void set_entity_state(CdrReader& request, std::uint32_t call);
  void spawn_entity(CdrReader& request, std::uint32_t call);
  void delete_entity(CdrReader& request, std::uint32_t call);
  void get_simulator_features(CdrReader& request, std::uint32_t call);

  Links links_;
  bool controls_;
  shoal::sim_state_t state_{};
  Clock::time_point now_{};
  std::uint32_t next_call_ = 0;
  std::map<std::uint32_t, Call> calls_;
  std::map<std::int32_t, Pending> pending_;  // by the number of the request
};

}  // namespace bridges::ros2
