// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/autonomy/acomms/channel_access.hpp"
#include "tools/autonomy/behaviours/helm_behaviour.hpp"
#include "tools/autonomy/behaviours/waypoint_text.hpp"

namespace autonomy {

/// When to send.
struct AccessOptions {
  std::string slot;
  double slot_s = 10;
  std::optional<double> guard_s;  ///< default_guard_s() unless set
  double random_s = 0;
  std::uint64_t seed = 1;

  /// `what` it sends, for the help.
  void add_options(CLI::App& app, const std::string& what);
  /// Throws std::invalid_argument with what is wrong.
  ChannelAccess::Params access() const;
};

/// The options that both programs of vehicles have.
struct MarineOptions {
  std::string route;
  std::string behaviour = "route";
  double speed_mps = 1.5;
  bool loop = false;
  AccessOptions sending;

  void add_options(CLI::App& app);
  /// Of the vehicle `name`.  Throw std::invalid_argument with what is wrong.
  std::unique_ptr<HelmBehaviour> make(const std::string& name) const;
  ChannelAccess::Params access() const { return sending.access(); }
};

}  // namespace autonomy
