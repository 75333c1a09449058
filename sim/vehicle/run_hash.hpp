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

/// A hash chained over what a world publishes and over its states, in the order in which they come: it stays
/// different after the first difference.
///
/// Counted are the messages that go through counted(): those of devices and of events, on every bus.  Channels for
/// observation only are excluded: truth channels and the simulator's own `sim.*`.
class RunHash {
 public:
  RunHash();
  ~RunHash();
  RunHash(const RunHash&) = delete;
  RunHash& operator=(const RunHash&) = delete;

  /// A bus that counts what is published on it and passes everything on to `bus`, which must outlive this.  The same
  /// one at every call.
  Bus& counted(Bus& bus);
  /// The bus under one that counted() gave; any other bus itself.
  static Bus& uncounted(Bus& bus);

  /// A state, by its hash.
  void add_state(std::uint64_t hash);
  /// The chain so far.
  std::uint64_t value() const { return chain_; }
  void visit_state(StateArchive& archive) { archive(chain_); }

 private:
  class CountedBus;
  void add_message(std::string_view channel, std::span<const std::byte> payload);

  std::uint64_t chain_ = 0;
  std::map<const Bus*, std::unique_ptr<CountedBus>> counted_;  // asked for by key, never iterated
};

}  // namespace sim
