// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "bridges/control/time_machine.hpp"
#include "sim/bus/bus.hpp"
#include "sim/run/run_control.hpp"
#include "tools/experiment/replay/replay_log.hpp"

namespace tools {

/// What programs and people ask on sim.control while a record is played: pause, resume, step, speed and where are
/// served, what would change a world is refused, and so is a client that asks only for channels that the record does
/// not have.
class PlayerRequests final : public bridges::TimeMachine {
 public:
  /// All must outlive this.  `where` says where the record is.
  PlayerRequests(const ReplayLog& log, sim::RunControl& control, sim::Bus& network, std::function<std::string()> where);

  std::optional<std::string> obey(const std::string& command, const std::string& text, double value) override;
  /// Warns of channels that a client asks for and the record does not have.  Call it before requests are handled.
  void look_at_joins();

 private:
  bool has(const std::string& channel) const;
  /// Throws when the record has none of the channels.
  void check_channels(const std::string& text) const;

  const ReplayLog& log_;
  sim::RunControl& control_;
  std::function<std::string()> where_;
  std::unique_ptr<sim::Mailbox> joins_;
  std::set<std::pair<std::string, std::string>> warned_;  // client and channel
};

}  // namespace tools
