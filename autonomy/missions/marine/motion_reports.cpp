// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/motion_reports.hpp"

#include <cmath>
#include <numbers>

#include "autonomy/filters/pose2.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

std::optional<DvlVelocity> velocity_of(const shoal::dvl_t& dvl) {
  const Eigen::Vector3d over_ground(dvl.velocity_mps[0], dvl.velocity_mps[1], dvl.velocity_mps[2]);
  const Eigen::Vector3d through_water(dvl.water_velocity_mps[0], dvl.water_velocity_mps[1], dvl.water_velocity_mps[2]);
  if (dvl.bottom_lock != 0 && over_ground.allFinite()) return DvlVelocity{over_ground, true};
  if (dvl.water_lock != 0 && through_water.allFinite()) return DvlVelocity{through_water, false};
  return std::nullopt;
}

void AttitudeReports::receive(std::int64_t time, const shoal::ins_t& attitude, const Eigen::Quaterniond& q_BS) {
  const Eigen::Quaterniond q_WS(attitude.quat[0], attitude.quat[1], attitude.quat[2], attitude.quat[3]);
  if (!(std::abs(q_WS.norm() - 1) < 0.01)) return;
  q_WB_ = q_WS.normalized() * q_BS.conjugate();
  ahrs_time_ = time_ = time;
}

void AttitudeReports::receive(std::int64_t time, const shoal::compass_t& compass) {
  if (ahrs_time_ && seconds(time - *ahrs_time_) < oldest_s) return;
  if (!std::isfinite(compass.heading_true_rad)) return;
  q_WB_ = Eigen::AngleAxisd(0.5 * std::numbers::pi - compass.heading_true_rad, Eigen::Vector3d::UnitZ());
  time_ = time;
}

void AttitudeReports::shift(std::int64_t by_us) {
  for (auto* time : {&ahrs_time_, &time_})
    if (*time) **time += by_us;
}

double AttitudeReports::yaw_rad() const {
  return sim::yaw_of(q_WB().toRotationMatrix());
}

bool AttitudeReports::is_lost(std::int64_t time) const {
  return time_ && seconds(time - *time_) > oldest_s;
}

}  // namespace autonomy
