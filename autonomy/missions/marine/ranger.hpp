// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/filters/wall_ekf.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/multibeam_t.hpp"
#include "shoal/pressure_t.hpp"
#include "shoal/sonar_range_t.hpp"

namespace autonomy {

/// AUV that inspects the wall of a dock: it takes fixes on a route at the surface, dives, continues by dead reckoning
/// with its IMU while ranges to the known walls bound the drift, and surfaces for a last fix.  It needs the three:
/// without fixes it does not know where it is, without IMU it does not know where it heads, without ranges it misses
/// the berth.  A pure function of its reports in their order; its time is that of their stamps.
class Ranger {
 public:
  struct Params {
    std::string name;
    int id = 1;                                       ///< in its frames
    std::vector<Vector2d> surface_W, dive_W, rise_W;  ///< routes
    std::vector<Wall> walls_W;
    double depth_m = 4;
    double speed_mps = 1.2;
    double pivot_m = 0;          ///< pivot point ahead of the origin: in a turn the hull slips outwards about it
    double altitude_min_m = 2;   ///< it does not go deeper than this height over the bottom
    double sonar_ahead_m = 0.7;  ///< of the origin of the vehicle
    double range_std_m = 0.2;
    double range_max_m = 60;  ///< longer ranges are not used
    double period_s = 0.5;    ///< between two calls of step()
    WallEkf::Params filter;
    ChannelAccess::Params access;
  };
  enum class Phase { waiting_for_fix, at_surface, dived, rising, done, lost };
  struct Decision {
    std::optional<shoal::helm_command_t> helm;         ///< for NAME.autopilot.cmd
    std::optional<shoal::estimate_t> estimate;         ///< for NAME.estimate
    std::optional<shoal::estimate_t> before_last_fix;  ///< for NAME.before_last_fix, once
    std::optional<shoal::modem_send_t> send;           ///< for NAME.modem.cmd
  };
  struct Counts {
    int fixes = 0, ranges = 0, refused = 0, sent = 0;
    double last_fix_m = unknown;  ///< distance of the last fix from the estimate before it
  };

  /// Throws std::invalid_argument for an empty route.
  explicit Ranger(const Params& params);

  void receive(const shoal::gps_data_t& fix);
  void receive(const shoal::imu_t& imu);
  void receive(const shoal::pressure_t& pressure);
  void receive(const shoal::sonar_range_t& altitude);
  /// A ping of the forward sonar, a multibeam sonar whose swath is horizontal and centered on the bow.
  void receive(const shoal::multibeam_t& ping);
  /// Computes the commands after all reports up to now.
  Decision step();

  Phase phase() const { return phase_; }
  const Counts& counts() const { return counts_; }
  const WallEkf* filter() const { return filter_ ? &*filter_ : nullptr; }

 private:
  double gyro_yaw_rad() const;
  void predict(std::int64_t utime);
  void start(const shoal::gps_data_t& fix, const Vector2d& p_W);
  void update_phase();
  RouteBehavior* route();
  shoal::helm_command_t helm();
  shoal::estimate_t estimate() const;
  std::optional<shoal::modem_send_t> state_frame(const shoal::estimate_t& estimate);

  Params params_;
  RouteBehavior surface_, dive_, rise_;
  ChannelAccess access_;
  Phase phase_ = Phase::waiting_for_fix;
  std::int64_t utime_ = 0;  ///< newest stamp
  std::optional<std::int64_t> imu_utime_, predicted_utime_, last_fix_utime_;
  std::optional<Eigen::Quaterniond> q_GB_;  ///< by the gyros, level by the accelerometers
  std::optional<WallEkf> filter_;
  double speed_mps_ = 0;  ///< through the water, by the commands
  double commanded_mps_ = 0;
  double turn_radps_ = 0;
  double depth_m_ = 0;
  std::optional<double> altitude_m_;
  std::optional<shoal::estimate_t> before_last_fix_;
  Counts counts_;
};

}  // namespace autonomy
