// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Messages that devices publish while threads share them, to be published later in the order of the devices.
class DeferredMessages {
 public:
  /// While it exists, what this thread publishes on channels of RunHash::counted() buses is deferred.
  class InThread {
   public:
    explicit InThread(DeferredMessages& messages);
    ~InThread();
    InThread(const InThread&) = delete;
    InThread& operator=(const InThread&) = delete;
  };
  void add(OpenChannel& channel, std::span<const std::byte> payload, Time at);
  /// Publishes all messages, in order, and removes them.
  void publish();

 private:
  struct Entry {
    OpenChannel* channel;
    Time at;
    std::size_t end;  // in bytes_
  };
  std::vector<Entry> entries_;
  Bytes bytes_;
};

/// Hash chained over the messages that a world publishes and over its states, in order: it stays different after the
/// first difference. The hash includes the messages published through counted(): those of devices and of events, on
/// every bus.  Channels for observation only are excluded: truth channels and the `sim.*` channels of the simulator.
class RunHash {
 public:
  RunHash();
  ~RunHash();
  RunHash(const RunHash&) = delete;
  RunHash& operator=(const RunHash&) = delete;

  /// Returns a bus that adds its publications to the hash and forwards everything to `bus`, which must outlive this.
  /// Returns the same object at every call.
  Bus& counted(Bus& bus);
  /// Returns the bus behind one returned by counted(); any other bus unchanged.
  static Bus& uncounted(Bus& bus);

  /// Adds a state, by its hash.
  void add_state(std::uint64_t hash);
  /// Returns the present value of the chain.
  std::uint64_t value() const { return chain_; }
  void visit_state(StateArchive& archive) { archive(chain_); }

 private:
  class CountedBus;
  class CountedChannel;
  void add_message(std::string_view channel, std::span<const std::byte> payload);

  std::uint64_t chain_ = 0;
  std::map<const Bus*, std::unique_ptr<CountedBus>> counted_;  // asked for by key, never iterated
};

}  // namespace sim
