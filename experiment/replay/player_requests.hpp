// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "bridges/control/sim_service.hpp"
#include "experiment/replay/replay_log.hpp"
#include "sim/bus/bus.hpp"
#include "sim/run/run_control.hpp"

namespace experiment {

/// Serves requests on sim.control during the playback of a record: pause, resume, step, speed and where.  Rejects
/// requests that would change a world, and clients that only subscribe to channels that the record lacks.
class PlayerRequests final : public bridges::TimeMachine {
 public:
  /// All must outlive this.  `where` returns the present position in the record.
  PlayerRequests(const ReplayLog& log, sim::RunControl& control, sim::Bus& network, std::function<std::string()> where);

  std::optional<std::string> execute(const std::string& command, const std::string& text, double value) override;
  /// Warns of channels that a client requests and the record lacks.  To be called before requests are handled.
  void check_joins();

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

}  // namespace experiment
