// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_inputs_t.hpp"
#include "sim/bus/byte_port.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// Recorded input of serial ports, to be read again at the same steps.
class SerialInputs {
 public:
  void add(std::int64_t step, const std::string& path, sim::Bytes bytes);
  /// Returns the bytes read from the port with this path at this step; empty when there are none.
  sim::Bytes read(const std::string& path, std::int64_t step);
  void clear() { waiting_.clear(); }

 private:
  std::map<std::string, std::deque<std::pair<std::int64_t, sim::Bytes>>> waiting_;
};

/// Serial ports of a world that record their input for a RunJournal.
class JournalPorts {
 public:
  struct Reading {
    std::int64_t step;
    std::string path;
    sim::Bytes bytes;
  };

  /// Returns an opener of such ports, which must not outlive this; empty for an empty one.
  sim::PortOpener wrap(sim::PortOpener open);
  /// Sets the step of the input read from now on.
  void begin_step(std::int64_t step) { step_ = step; }
  /// Returns the input since the last call.
  std::vector<Reading> take() { return std::exchange(read_, {}); }
  /// Mutes the ports: while muted, they deliver the recorded input, and drop the bytes written to them.
  void mute(bool muted) {
    muted_ = muted;
    inputs_.clear();
  }
  SerialInputs& input_record() { return inputs_; }

 private:
  class Port;

  std::int64_t step_ = 0;
  bool muted_ = false;
  std::vector<Reading> read_;
  SerialInputs inputs_;
};

/// Journal on the bus of the world that makes a run repeatable: all external inputs of the world (sim.inputs), and
/// hashes to verify that a replay is equal (sim.hash).
class RunJournal {
 public:
  /// Value of sim_input_t::bus for bytes of pseudo-terminals and FIFOs.
  static constexpr const char* serial_bus = "serial";
  /// Value of sim_input_t::channel for a request that changes the world.
  static constexpr const char* request_channel = "sim.control";
  /// Value of sim_hash_t::part, after the parts of the state, for WorldState::run_hash().  Unique, because names in a
  /// world have no spaces.
  static constexpr const char* run_hash_part = "run hash";
  /// Value of sim_input_t::step before the first reports.
  static constexpr std::int64_t before_first_reports = -1;

  /// External input of the world; see sim_input_t.
  struct Input {
    std::string bus, channel;
    sim::Bytes payload;
  };

  /// `bus`: recorded bus of the world; `ports`: ports of `world`.  All must outlive this.  Hashes are computed while
  /// `is_observed` returns true, that is while a subscriber may exist; empty: always.
  RunJournal(sim::Bus& bus, const sim::World& world, JournalPorts& ports, std::function<bool()> is_observed = {});

  /// Starts the journal, before the first reports are published.
  void start() {
    started_ = true;
    begin_step();
  }
  /// Starts a step; needed before each step when after_step() is not called.
  void begin_step() { ports_.begin_step(step()); }

  /// Records messages that were admitted at the start of a step.
  void admitted(const std::string& bus, std::span<const sim::MessageGate::Delivery> input_record);
  /// Records a request that is about to change the world.
  void request(const shoal::sim_control_request_t& request);
  void input(const std::string& bus, const std::string& channel, std::span<const std::byte> payload);
  /// Sets a callback for every input when it is delivered; empty: none.
  using Listener = std::function<void(std::int64_t step, const Input& input)>;
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  /// Ends a step: publishes its inputs, and a hash when one is due.
  void after_step();
  /// Ends the journal: publishes pending inputs and, unless the last step was interrupted, a last hash; without hashes,
  /// an empty sim.inputs.  May be called twice.
  void finish(bool step_is_whole = true);

  /// Mutes the journal while a part of a run is recomputed: nothing is published or recorded, and serial ports deliver
  /// the input in serial_inputs() and drop the bytes written to them.
  void mute(bool muted) {
    muted_ = muted;
    ports_.mute(muted);
    begin_step();
  }
  SerialInputs& serial_inputs() { return ports_.input_record(); }
  /// Starts another branch after a rewind.
  void start_branch(std::int32_t branch, std::int64_t next_sequence);
  std::int32_t branch() const { return branch_; }
  /// Returns the sequence of the next sim.inputs.
  std::int64_t sequence() const { return sequence_; }

 private:
  std::int64_t step() const { return started_ ? world_.step_number() : before_first_reports; }
  void add(std::int64_t step, const std::string& bus, const std::string& channel, std::span<const std::byte> payload);
  void take_readings();
  void publish_inputs();
  void publish_hash();

  sim::Bus& bus_;
  const sim::World& world_;
  JournalPorts& ports_;
  std::int64_t every_steps_;
  bool started_ = false, muted_ = false;
  std::int32_t branch_ = 0;
  std::int64_t sequence_ = 0;
  std::int64_t last_hash_step_ = -1;  // step of the last hash, or of its substitute
  std::vector<shoal::sim_input_t> waiting_;
  std::size_t waiting_bytes_ = 0;
  sim::Bytes buffer_;
  Listener listener_;
  std::function<bool()> is_observed_;
};

}  // namespace bridges
