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
  /// What was read from the port of this path at this step; empty when nothing was.
  sim::Bytes read(const std::string& path, std::int64_t step);
  void clear() { waiting_.clear(); }

 private:
  std::map<std::string, std::deque<std::pair<std::int64_t, sim::Bytes>>> waiting_;
};

/// Serial ports of a world that write down what they read, for a RunJournal.
class JournalPorts {
 public:
  struct Reading {
    std::int64_t step;
    std::string path;
    sim::Bytes bytes;
  };

  /// An opener of such ports, which must not outlive this.  Empty for an empty one.
  sim::PortOpener wrap(sim::PortOpener open);
  /// What is read from now on is read at this step.
  void begin_step(std::int64_t step) { step_ = step; }
  /// What was read since the last call.
  std::vector<Reading> take() { return std::exchange(read_, {}); }
  /// While muted, ports deliver the recorded input, and drop what is written to them.
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

/// Publishes on the world's bus what makes a run repeatable: all inputs of the world from outside (sim.inputs), and
/// hashes that prove that a replay is equal (sim.hash).
class RunJournal {
 public:
  /// In sim_input_t::bus, for bytes of pseudo-terminals and FIFOs.
  static constexpr const char* serial_bus = "serial";
  /// In sim_input_t::channel, for a request that changes the world.
  static constexpr const char* request_channel = "sim.control";
  /// In sim_hash_t::part, after the parts of the state: WorldState::run_hash().  No name in a world has a space.
  static constexpr const char* run_hash_part = "run hash";
  /// In sim_input_t::step, before the first reports.
  static constexpr std::int64_t before_first_reports = -1;

  /// Something that came to the world from outside; see sim_input_t.
  struct Input {
    std::string bus, channel;
    sim::Bytes payload;
  };

  /// `bus`: the world's, recorded; `ports`: those of `world`.  All must outlive this.  Hashes are computed while
  /// `received` returns true, that is while a subscriber may exist; empty: always.
  RunJournal(sim::Bus& bus, const sim::World& world, JournalPorts& ports, std::function<bool()> received = {});

  /// The first reports go out next.
  void start() {
    started_ = true;
    begin_step();
  }
  /// Before each step that is not followed by after_step().
  void begin_step() { ports_.begin_step(step()); }

  /// Messages that were admitted at the start of a step.
  void admitted(const std::string& bus, std::span<const sim::MessageGate::Delivery> input_record);
  /// A request that is about to change the world.
  void request(const shoal::sim_control_request_t& request);
  void input(const std::string& bus, const std::string& channel, std::span<const std::byte> payload);
  /// `listener` is called for every input when it is delivered; empty: none.
  using Listener = std::function<void(std::int64_t step, const Input& input)>;
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  /// After each step: publishes what came to it, and a hash when one is due.
  void after_step();
  /// Publishes what is pending and, unless the last step was interrupted, a last hash; without hashes, an empty
  /// sim.inputs.  Safe to call twice.
  void finish(bool step_is_whole = true);

  /// While a part of a run is recomputed, nothing is published or recorded, and serial ports deliver the input in
  /// serial_inputs() and drop what is written to them.
  void mute(bool muted) {
    muted_ = muted;
    ports_.mute(muted);
    begin_step();
  }
  SerialInputs& serial_inputs() { return ports_.input_record(); }
  /// After a rewind: what is published from now on belongs to another branch.
  void start_branch(std::int32_t branch, std::int64_t next_sequence);
  std::int32_t branch() const { return branch_; }
  /// Of the next sim.inputs.
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
  std::int64_t last_hash_step_ = -1;  // or of what stands for the last one
  std::vector<shoal::sim_input_t> waiting_;
  std::size_t waiting_bytes_ = 0;
  sim::Bytes buffer_;
  Listener listener_;
  std::function<bool()> is_observed_;
};

}  // namespace bridges
