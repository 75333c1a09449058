// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"

namespace sim {
class World;
}

namespace bridges {

/// External intervention in a run: see sim_audit_t.
struct AuditEntry {
  double sim_time_s = 0;
  std::string kind;    ///< quit, rewind, restore, remove, leave, contradiction
  std::string client;  ///< name claimed by the sender
  std::string signer;  ///< sender verified by the key of the run; empty: no key was required
  std::string text;
};

/// Audit of a run: publishes and stores which clients made it end, rewind, or lose data, for the record and the
/// summary.  Part of the run, not of the world: a rewind does not change it.
class RunAudit {
 public:
  static constexpr std::size_t max_kept = 100;
  static constexpr std::size_t max_published = 10'000;

  /// `bus`: recorded bus of the world.  Both must outlive this.
  RunAudit(sim::Bus& bus, const sim::World& world) : bus_(bus), world_(world) {}

  void add(AuditEntry audit_entry, std::int32_t branch);
  /// Returns the first entries.
  const std::vector<AuditEntry>& all() const { return all_; }
  /// Returns the number of entries.
  std::int64_t count() const { return count_; }

 private:
  sim::Bus& bus_;
  const sim::World& world_;
  std::vector<AuditEntry> all_;
  std::int64_t count_ = 0;
  sim::Bytes buffer_;
};

/// Returns `client 'NAME'` with its signer, for texts on a terminal.
std::string who_asked(const std::string& client, const std::string& signer);

}  // namespace bridges
