// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "tools/command_line/declared_options.hpp"

namespace autonomy {

/// Options of channel access.
struct AccessOptions {
  std::optional<int> slot, slots;
  double slot_s = 10;
  std::optional<double> guard_s;  ///< default_guard_s() unless set
  std::optional<double> random_s;
  std::uint64_t seed = 1;

  /// `what`: description of the sent data, for the help.
  void declare(command_line::DeclaredOptions& options, const std::string& what);
  /// Throws std::invalid_argument with the reason.
  ChannelAccess::Params access() const;
};

/// Options common to both programs of vehicles.
struct MarineOptions {
  std::vector<Vector2d> waypoints_W;
  std::vector<double> circle_m, zigzag_m;  ///< columns as declared; empty: not given
  std::optional<int> zigzag_legs;
  std::string follow;
  std::vector<double> follow_offset_m;
  std::string leader, formation = "vee";
  int formation_place = 1;
  double spacing_m = 20;
  std::vector<double> formation_offset;  ///< as `follow_offset_m`
  double speed_mps = 1.5;
  bool loop = false;
  AccessOptions sending;

  void declare(command_line::DeclaredOptions& options);
  /// Returns the behavior of the vehicle `name`.  Throws std::invalid_argument with the reason.
  std::unique_ptr<HelmBehavior> make(const std::string& name) const;
  ChannelAccess::Params access() const { return sending.access(); }

 private:
  std::unique_ptr<HelmBehavior> make_place(const std::string& name) const;
};

/// Returns the waypoints of the columns x and y.
std::vector<Vector2d> points_of(const std::vector<std::vector<double>>& lists);

}  // namespace autonomy
