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

/// Something that happened to a run from outside: see sim_audit_t.
struct AuditEntry {
  double sim_time_s = 0;
  std::string kind;    ///< quit, rewind, restore, remove, leave, contradiction
  std::string client;  ///< name that the sender gave itself
  std::string signer;  ///< sender that had the key of the run; empty: no key was required
  std::string text;
};

/// Publishes and keeps which clients made a run end, rewind, or lose something, for the record and the summary.  Of the
/// run, not of the world: going back in time leaves it as it is.
class RunAudit {
 public:
  static constexpr std::size_t max_kept = 100;
  static constexpr std::size_t max_published = 10'000;

  /// `bus`: the world's, recorded.  Both must outlive this.
  RunAudit(sim::Bus& bus, const sim::World& world) : bus_(bus), world_(world) {}

  void add(AuditEntry audit_entry, std::int32_t branch);
  /// The first ones.
  const std::vector<AuditEntry>& all() const { return all_; }
  /// How many there were.
  std::int64_t count() const { return count_; }

 private:
  sim::Bus& bus_;
  const sim::World& world_;
  std::vector<AuditEntry> all_;
  std::int64_t count_ = 0;
  sim::Bytes buffer_;
};

/// `client 'NAME'`, and with which key: for texts on a terminal.
std::string who_asked(const std::string& client, const std::string& signer);

}  // namespace bridges
