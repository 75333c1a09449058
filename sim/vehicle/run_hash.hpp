// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

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
  void add_message(std::string_view channel, std::span<const std::byte> payload);

  std::uint64_t chain_ = 0;
  std::map<const Bus*, std::unique_ptr<CountedBus>> counted_;  // asked for by key, never iterated
};

}  // namespace sim
