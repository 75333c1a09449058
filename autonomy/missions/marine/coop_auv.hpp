// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/acomms/state_packet.hpp"
#include "autonomy/behaviors/cloned.hpp"
#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/filters/range_aided_ekf.hpp"
#include "autonomy/missions/marine/mission_phases.hpp"
#include "autonomy/missions/marine/motion_reports.hpp"
#include "autonomy/missions/marine/report_clock.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/compass_t.hpp"
#include "shoal/dvl_t.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/ins_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/multibeam_t.hpp"
#include "shoal/pressure_t.hpp"

namespace autonomy {

/// AUV that localizes itself by DVL, heading and depth, and by one-way ranges to vehicles that report their positions
/// by acoustic modem.  In addition it keeps an estimate by dead reckoning only.  It waits at the surface for GPS,
/// dives, follows its behavior, and surfaces.  A pure function of its reports in their order; its time is that of
/// their stamps, by the vehicle's own clock.
///
/// Its filter is that of the algorithm `coop_auv` of shoal-nav (RangeAidedEkf).  It is not itself a
/// navigation::Estimator behind navigation::VehicleReports and Navigator, since what goes into the filter differs:
///
///   - It knows its arguments only: one speed of sound, one error of ranges, two lever arms, the parameters of the
///     filter.  VehicleReports takes all that from the vehicle files and the sound profile of the world.
///   - Ranges are to the states that any vehicle broadcasts, with their velocities; those of an Estimator are to the
///     payloads of its team, by the clocks of its members.
///   - A late range updates the present state (MarineEkf); Navigator keeps 20 s of events and an older estimator to
///     repeat them, which every copy for a rewind would contain.
///   - A clock that was set restarts the clock states; VehicleReports hides it from an Estimator.
///   - A lost heading and a DVL that is silent for 1 s add noise, and fixes have a period.  VehicleReports only knows
///     silence of more than 5 s.
class CoopAuv {
 public:
  struct Params {
    std::string name;
    int id = 100;  ///< in its frames
    double depth_m = 10;
    MarineEkf::Params filter;
    bool use_ranges = true;
    bool steer_by_dead_reckoning = false;
    double sound_speed_mps = 1500;   ///< converts travel times to ranges
    double range_std_m = 1.0;        ///< of one range
    double sound_speed_std = 0.001;  ///< of the range
    /// Offsets from the estimated point, in the vehicle's axes.
    Eigen::Vector3d modem_B = Eigen::Vector3d::Zero(), gps_B = Eigen::Vector3d::Zero();
    double surface_s = 10;            ///< at the surface after the first fix
    double fix_period_s = 5;          ///< GPS errors are correlated in time, so that more fixes add little
    std::optional<Vector2d> start_W;  ///< known start: it does not wait for GPS
    double start_std_m = 1;
    ChannelAccess::Params access;    ///< for its own state
    double period_s = 0.5;           ///< between two calls of step()
    bool execute = false;            ///< executes orders for its id: it moves to the position and circles there
    double order_depth_max_m = 100;  ///< limit of the depth of an order
    double order_speed_max_mps = 2.5;
    double hold_radius_m = 30;
  };
  struct Decision {
    std::optional<shoal::helm_command_t> helm;        ///< for NAME.autopilot.cmd
    std::optional<shoal::estimate_t> estimate;        ///< for NAME.estimate
    std::optional<shoal::estimate_t> dead_reckoning;  ///< for NAME.dead_reckoning
    std::optional<shoal::modem_send_t> send;          ///< for NAME.modem.cmd
  };
  struct Counts {
    int frames = 0;
    int bad_frames = 0;
    int ranges = 0;   ///< used
    int refused = 0;  ///< by the filter, or too late, or with an impossible travel time
    int sent = 0;
    int clock_steps = 0;
    int silences = 0;        ///< of all devices
    int relayed = 0;         ///< states that were not sent by their own vehicle: no ranges
    int orders = 0;          ///< executed
    int orders_refused = 0;  ///< each counted once
  };
  using Phase = MissionPhases::Phase;

  /// Throws std::invalid_argument for a number of states that the filter does not support.
  CoopAuv(const Params& params, std::unique_ptr<HelmBehavior> behavior);

  void receive(const shoal::dvl_t& dvl);
  void receive(const shoal::ins_t& attitude);
  void receive(const shoal::compass_t& compass);
  void receive(const shoal::pressure_t& pressure);
  void receive(const shoal::gps_data_t& fix);
  void receive(const shoal::acoustic_received_t& packet);
  /// Processes a ping of the forward sonar, a multibeam sonar whose swath is horizontal and centered on the bow.
  void receive(const shoal::multibeam_t& ping);
  /// Computes the commands after all reports up to now.
  Decision step();

  /// Null before the position is known.
  const MarineEkf* cooperative() const { return filter_ ? &filter_->with_ranges() : nullptr; }
  const MarineEkf* dead_reckoning() const { return filter_ ? &filter_->without_ranges() : nullptr; }
  Phase phase() const { return phases_.phase(); }
  const Counts& counts() const { return counts_; }

 private:
  void note_time(std::int64_t utime);
  void set_clock(std::int64_t by_us);
  void start(std::int64_t utime, const Vector2d& p_W, double std_m);
  void predict(std::int64_t utime);
  Motion motion_at(const MarineEkf& filter, std::int64_t utime) const;
  const MarineEkf& steered_by() const { return params_.steer_by_dead_reckoning ? *dead_reckoning() : *cooperative(); }
  void execute(const AcousticOrder& order);
  OrderRefusal refusal_of(const AcousticOrder& order) const;
  void use_range(const shoal::acoustic_received_t& packet, const AcousticState& beacon);
  shoal::helm_command_t helm();
  shoal::estimate_t estimate(const MarineEkf& filter) const;
  double yaw_by(const MarineEkf& filter) const;
  std::optional<shoal::modem_send_t> state_frame(const shoal::estimate_t& estimate);

  Params params_;
  Cloned<HelmBehavior> behavior_;
  ChannelAccess access_;
  DirectStates direct_;
  int order_ = 0;          ///< number of the last one executed
  int refused_order_ = 0;  ///< number of the last one refused, when later than that
  OrderRefusal refusal_ = OrderRefusal::none;
  double desired_depth_m_ = 0;  ///< when under way
  std::optional<RangeAidedEkf> filter_;

  ReportClock clock_;
  AttitudeReports attitude_;
  Eigen::Vector3d v_B_ = Eigen::Vector3d::Zero();
  double velocity_noise_mpsprtHz_ = 0;  ///< noise in addition to that of a DVL with bottom track
  std::optional<std::int64_t> velocity_utime_;
  double depth_m_ = 0;
  std::optional<std::int64_t> fix_utime_;
  MissionPhases phases_;
  Counts counts_;
};

}  // namespace autonomy
