// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/acomms/state_packet.hpp"
#include "autonomy/behaviors/cloned.hpp"
#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/missions/marine/motion_reports.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace autonomy {

/// Surface craft that broadcasts its GPS position by acoustic modem.  A pure function of its reports in their order;
/// its time is that of the reports' stamps, the vehicle's own clock.
class CoopCraft {
 public:
  struct Params {
    std::string name;
    int id = 1;                       ///< in its frames
    double transducer_depth_m = 0.5;  ///< of the modem, below the surface
    double oldest_fix_s = 3;          ///< maximum age of a fix
    double period_s = 0.5;            ///< between two calls of step()
    double timeout_s = 60;            ///< time after which it reports what its behavior waits for
    ChannelAccess::Params access;
  };
  struct Decision {
    std::optional<shoal::helm_command_t> helm;  ///< for NAME.autopilot.cmd
    std::optional<shoal::estimate_t> estimate;  ///< for NAME.estimate
    std::optional<shoal::modem_send_t> send;    ///< for NAME.modem.cmd
    std::string remark;                         ///< message for the user; empty: none
  };
  struct Counts {
    int sent = 0;
    int received = 0;
    int relayed = 0;  ///< states that were not sent by their own vehicle, and are not used
    int orders = 0;   ///< addressed to others
    int bad_frames = 0;
  };

  CoopCraft(const Params& params, std::unique_ptr<HelmBehavior> behavior);

  void receive(const shoal::gps_data_t& fix);
  void receive(const shoal::acoustic_received_t& packet);
  void receive(const shoal::ins_t& attitude);
  void receive(const shoal::planar_lidar_t& scan);
  /// Computes the commands after all reports up to now.
  Decision step();

  const Counts& counts() const { return counts_; }
  const HelmBehavior& behavior() const { return *behavior_; }

 private:
  shoal::estimate_t estimate() const;
  std::optional<shoal::modem_send_t> state_frame(const shoal::estimate_t& estimate);
  std::string remark();
  /// Returns the own motion at a time, by the last fix.  There must be one.
  Motion motion_at(std::int64_t utime) const;

  Params params_;
  Cloned<HelmBehavior> behavior_;
  ChannelAccess access_;
  DirectStates direct_;
  std::int64_t utime_ = 0;  ///< newest stamp
  std::optional<std::int64_t> patient_since_;
  bool remarked_ = false;
  std::optional<Motion> motion_;
  AttitudeReports attitude_;
  int steps_since_fix_ = 0;
  double position_std_m_ = 0;
  Counts counts_;
};

}  // namespace autonomy
