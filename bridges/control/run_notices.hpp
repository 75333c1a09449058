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

/// Something that happened to a run from outside: see sim_notice_t.
struct RunNotice {
  double sim_time_s = 0;
  std::string kind;    ///< quit, rewind, restore, remove, leave, contradiction
  std::string client;  ///< name that the sender gave itself
  std::string signer;  ///< who had the key of the run; empty: it was not asked for
  std::string text;
};

/// Publishes and keeps who made a run end, go back, or lose something, for the record and the summary.  Of the run, not
/// of the world: going back in time leaves it as it is.
class RunNotices {
 public:
  static constexpr std::size_t max_kept = 100;
  static constexpr std::size_t max_published = 10'000;

  /// `bus`: the world's, recorded.  Both must outlive this.
  RunNotices(sim::Bus& bus, const sim::World& world) : bus_(bus), world_(world) {}

  void add(RunNotice notice, std::int32_t branch);
  /// The first ones.
  const std::vector<RunNotice>& all() const { return all_; }
  /// How many there were.
  std::int64_t count() const { return count_; }

 private:
  sim::Bus& bus_;
  const sim::World& world_;
  std::vector<RunNotice> all_;
  std::int64_t count_ = 0;
  sim::Bytes buffer_;
};

/// `client 'NAME'`, and with which key: for texts on a terminal.
std::string who_asked(const std::string& client, const std::string& signer);

}  // namespace bridges
