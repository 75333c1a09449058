// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/behaviors/cloned.hpp"
#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/cooperative/driver/vehicle_navigation.hpp"
#include "autonomy/missions/marine/mission_phases.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/modem_send_t.hpp"

namespace navigation {

/// Autonomy of a marine vehicle that steers by its estimate: it waits for its first fix (unless the start is known),
/// stays at the surface for some time, dives, follows its behavior, and surfaces.  A surface craft has depth 0.  A
/// value; a function of its reports in their order.
class NavPilot {
 public:
  struct Params {
    std::string name;
    const Algorithm* algorithm = nullptr;
    NavOptions navigation;
    double depth_m = 0;
    double surface_s = 10;  ///< at the surface after the start
    autonomy::ChannelAccess::Params access;
  };
  struct Decision {
    std::optional<shoal::helm_command_t> helm;  ///< for NAME.autopilot.cmd
    std::optional<shoal::estimate_t> estimate;  ///< for NAME.estimate
    std::optional<shoal::modem_send_t> send;    ///< for the modem
  };
  struct Counts {
    int frames = 0;  ///< received
    int sent = 0;
  };

  /// Throws std::invalid_argument when the vehicle is not in the team, or the algorithm cannot work.
  NavPilot(std::shared_ptr<const NavTeam> team, const Params& params, std::unique_ptr<autonomy::HelmBehavior> behavior);

  template <class Message>
  void receive(const Message& report) {
    navigation_.receive(report);
  }
  void receive(const shoal::acoustic_received_t& packet);
  /// Decides after all reports up to now.
  Decision step();

  const VehicleNavigation& navigation() const { return navigation_; }
  const Counts& counts() const { return counts_; }

 private:
  shoal::helm_command_t at_rest() const;
  shoal::helm_command_t helm(const Estimate& estimate);

  Params params_;
  VehicleNavigation navigation_;
  autonomy::Cloned<autonomy::HelmBehavior> behavior_;
  autonomy::ChannelAccess access_;
  autonomy::MissionPhases phases_;
  Time estimated_at_ = 0;
  Counts counts_;
};

}  // namespace navigation
