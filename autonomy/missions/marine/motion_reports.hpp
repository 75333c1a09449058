// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "shoal/compass_t.hpp"
#include "shoal/dvl_t.hpp"
#include "shoal/ins_t.hpp"

namespace autonomy {

/// Velocity that a DVL measured, in its own axes.
struct DvlVelocity {
  Eigen::Vector3d v_S = Eigen::Vector3d::Zero();
  bool over_ground = false;  ///< otherwise through the water

  /// Returns the noise of it as a velocity over ground, in addition to that of bottom track: the current is unknown.
  double noise_mpsprtHz() const { return over_ground ? 0 : 0.3; }
};
/// Returns the velocity over ground with bottom lock, else that through the water; nothing with neither lock.
std::optional<DvlVelocity> velocity_of(const shoal::dvl_t& dvl);

/// Attitude of a vehicle by its AHRS, and by its compass while the AHRS is silent.
class AttitudeReports {
 public:
  /// Time after which a silent AHRS, or all sources of heading, count as failed.
  static constexpr double oldest_s = 2;

  /// Processes a report; `time`: its stamp, by a clock that the caller chooses. `q_BS`: how the AHRS is mounted.
  void receive(std::int64_t time, const shoal::ins_t& attitude,
               const Eigen::Quaterniond& q_BS = Eigen::Quaterniond::Identity());
  void receive(std::int64_t time, const shoal::compass_t& compass);
  /// Moves the times of the reports, because that clock was set.
  void shift(std::int64_t by_us);

  bool is_known() const { return q_WB_.has_value(); }
  /// The last attitude; no rotation before the first report.
  Eigen::Quaterniond q_WB() const { return q_WB_.value_or(Eigen::Quaterniond::Identity()); }
  /// Measured heading, counter-clockwise from east.
  double yaw_rad() const;
  bool is_lost(std::int64_t time) const;

 private:
  std::optional<Eigen::Quaterniond> q_WB_;
  std::optional<std::int64_t> ahrs_time_;
  std::optional<std::int64_t> time_;  ///< of the device that reported it last
};

}  // namespace autonomy
