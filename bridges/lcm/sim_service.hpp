#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/run/lockstep.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// A lockstep client did not answer in time.
class LockstepTimeout : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The simulator's own channels: publishes sim.info, sim.clock, sim.state and sim.tick, answers requests on
/// sim.control, and takes acknowledgements on sim.ack.  Speaks through any Bus.
class SimService {
 public:
  struct Info {
    std::string resolved_config;
    std::string versions;
  };

  /// `network`: the bus under `bus`; the handshake goes there directly, so that records leave it out.
  SimService(sim::Bus& bus, sim::Bus& network, const sim::World& world, sim::RunControl& control,
             sim::Lockstep& lockstep, Info info);

  /// Publishes what is due after the world's current step: clock, state, info.
  void publish_step();
  /// Answers the requests that have come.
  void handle_requests();
  /// Tells clients that the run is over.
  void publish_end();

  /// Waits for messages up to the given time, or returns earlier.
  using Wait = std::function<void(std::chrono::milliseconds)>;
  /// Listens for 0.3 s of wall time, before anything is published: two simulators that answer the same clients would
  /// spoil each other's runs.
  bool hears_another_simulator(const Wait& wait);
  /// Step 8 of a step: ticks the clients that are due and waits for their acknowledgements.  `idle` is called
  /// while waiting; false ends the wait.  Throws LockstepTimeout after `timeout_s` of wall time without an
  /// answer.
  void synchronize(double timeout_s, const Wait& wait, const std::function<bool()>& idle);
  /// Bad requests and acknowledgements so far.
  std::int64_t bad_messages() const { return bad_messages_; }

 private:
  void publish_info();
  void publish_state();
  void publish_tick(const std::vector<std::string>& clients, bool last);
  void take_acknowledgements();
  std::string obey(const shoal::sim_control_request_t& request);
  std::string join(const shoal::sim_control_request_t& request);
  std::string set_speed(double speed);
  void complain(const std::string& text);
  bool due(double rate_hz) const;
  template <typename Message>
  void publish(sim::Bus& bus, const std::string& channel, const Message& message);

  sim::Bus& bus_;
  sim::Bus& network_;
  const sim::World& world_;
  sim::RunControl& control_;
  sim::Lockstep& lockstep_;
  Info info_;
  std::unique_ptr<sim::Mailbox> requests_, acknowledgements_;
  sim::Bytes buffer_;
  std::int64_t bad_messages_ = 0;
};

}  // namespace bridges
