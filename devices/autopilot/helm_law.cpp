// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/helm_law.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

namespace {

// Speed below which a craft without sway control keeps its heading at a station.
constexpr double idle_mps = 0.05;

Eigen::Vector2d at_most(const Eigen::Vector2d& v, double length) {
  const double norm = v.norm();
  return norm > length ? Eigen::Vector2d(v * (length / norm)) : v;
}

}  // namespace

void HelmGains::read(sim::ParamReader& in) {
  in.read("heading", heading, "heading control, rad and rad/s");
  in.read("depth", depth, "control of depth or altitude by thrusters, m and m/s");
  in.read("attitude", attitude, "control of roll and pitch, rad and rad/s");
  in.read("position", position, "station keeping, m and m/s");
  in.read("speed_bandwidth_radps", speed_bandwidth_radps, sim::above_to(0, 100), "speed control");
  in.read("speed_integral", speed_integral, sim::between(0, 1), "gain of the integral of its error");
  in.read("climb_gain_per_s", climb_gain_per_s, sim::above_to(0, 10), "with fins: climb in m/s per m of depth error");
  in.read("steerage_mps", steerage_mps, sim::above(0),
          "with fins: minimum speed when holding a station, which it passes repeatedly");
  in.read_deg("pitch_max_deg", pitch_max_rad, sim::above_to(0, 80), "with fins: the steepest climb or dive");
}

HelmLaw::HelmLaw(const HelmGains& gains, const CraftAbilities& craft)
    : gains_(gains),
      craft_(craft),
      heading_(gains.heading),
      depth_(gains.depth),
      roll_(gains.attitude),
      pitch_(gains.attitude),
      east_(gains.position),
      north_(gains.position),
      speed_(gains.speed_bandwidth_radps, gains.speed_integral) {}

/// Sets heading and speed towards the station, for a craft without sway control.  In the steady state it heads against
/// the current.
void HelmLaw::hold_station_ahead(const CraftMotion& motion, const Eigen::Vector2d& station, Demand& demand) const {
  const HoldGains& gains = gains_.position;
  // Lower bandwidth than with sway control, because the heading must settle first.
  const double k = 0.2 * gains.bandwidth_radps / gains.damping;
  const Eigen::Vector2d error = station - motion.X_WS.translation().head<2>();
  if (craft_.fins) {
    demand.heading_rad = std::atan2(error.y(), error.x());
    demand.speed_mps = std::clamp(k * error.norm(), gains_.steerage_mps, std::max(gains_.steerage_mps, gains.rate_max));
    return;
  }
  // Velocity through the water: towards the station, and against the drift.
  const Eigen::Vector2d desired = at_most(k * error, gains.rate_max) - drift_mps_;
  if (desired.norm() < idle_mps) return;
  // Head along it; advance only in proportion to the alignment of the heading.
  demand.heading_rad = std::atan2(desired.y(), desired.x());
  const double turn = sim::wrap_angle(demand.heading_rad - sim::yaw_of(motion.X_WS.linear()));
  demand.speed_mps = desired.norm() * std::max(0.0, std::cos(turn));
}

/// Returns the desired pitch (positive nose down) of a craft with fins, to reach a height.
double HelmLaw::pitch_for(const CraftMotion& motion, double height_m, double dt_s) {
  const double k = gains_.climb_gain_per_s;
  const double error = height_m - motion.X_WS.translation().z();
  const double speed = std::max(slowest_mps, motion.v_S.x());
  const double nose_up = std::asin(std::clamp(k * error / speed, -1.0, 1.0)) + climb_sum_rad_;
  const double kept = std::clamp(nose_up, -gains_.pitch_max_rad, gains_.pitch_max_rad);
  // The integral grows only where the pitch follows its setpoint (anti-windup).
  constexpr double followed_rad = 0.2;
  const bool follows =
      kept == nose_up && std::abs(kept + sim::rpy_from_rotation(motion.X_WS.linear()).y()) < followed_rad;
  if (follows || error * climb_sum_rad_ < 0) climb_sum_rad_ += gains_.depth.integral * k * k / speed * error * dt_s;
  return -kept;
}

Demand HelmLaw::step(const CraftMotion& motion, const Setpoint& desired, double dt_s, const Wrench& given) {
  // Rotation from W by yaw alone: a force against a current must tilt with the craft, as its drag does.  Beside a drag
  // that has tilted it would push the craft down or up, which adds to the Munk moment.
  const sim::Matrix3d& R_WS = motion.X_WS.linear();
  sim::Matrix3d R_WL = Eigen::AngleAxisd(sim::yaw_of(R_WS), sim::Vector3d::UnitZ()).toRotationMatrix();
  R_WL(2, 2) = R_WS(2, 2);  // what heave gives of a vertical acceleration
  // Accelerations by the actuators since the last step.
  const Wrench gave_S = given.cwiseQuotient(craft_.mass);
  const sim::Vector3d gave_W = R_WL * gave_S.head<3>();
  // Drift, as steady as the position is held.
  const Eigen::Vector2d drift_mps = (motion.v_WS_W - R_WS.col(0) * motion.v_S.x()).head<2>();
  drift_mps_ +=
      std::min(1.0, gains_.position.integral * gains_.position.bandwidth_radps * dt_s) * (drift_mps - drift_mps_);
  // Setpoints of heading and speed.
  Demand demand;
  demand.heading_rad = desired.heading_rad;
  demand.speed_mps = desired.station_m ? 0 : desired.speed_mps;
  const sim::Vector3d rpy = sim::rpy_from_rotation(R_WS), p = motion.X_WS.translation();
  sim::Vector3d a_W = sim::Vector3d::Zero(), a_S = sim::Vector3d::Zero(), turn_S;
  // Horizontal accelerations: station keeping or speed.
  if (desired.station_m && craft_.sideways) {
    a_W.x() = east_.step(desired.station_m->x() - p.x(), motion.v_WS_W.x(), gave_W.x(), dt_s);
    a_W.y() = north_.step(desired.station_m->y() - p.y(), motion.v_WS_W.y(), gave_W.y(), dt_s);
    speed_.reset();
  } else {
    if (desired.station_m) hold_station_ahead(motion, *desired.station_m, demand);
    demand.speed_error_mps = demand.speed_mps - motion.v_S.x();
    a_S.x() = speed_.step(demand.speed_error_mps, motion.v_S.x(), gave_S.x(), dt_s);
    a_S.y() = -gains_.speed_bandwidth_radps * motion.v_S.y();
    east_.reset();
    north_.reset();
  }
  // Vertical motion: by pitch with fins, by heave with thrusters.
  double pitch = 0;
  if (craft_.fins)
    pitch = pitch_for(motion, desired.height_m, dt_s);
  else if (craft_.heaves)
    a_W.z() = depth_.step(desired.height_m - p.z(), motion.v_WS_W.z(), gave_W.z(), dt_s);
  // Angular accelerations.
  demand.heading_error_rad = sim::wrap_angle(demand.heading_rad - rpy.z());
  turn_S.x() = roll_.step(-rpy.x(), motion.w_S.x(), gave_S[3], dt_s);
  turn_S.y() = pitch_.step(pitch - rpy.y(), motion.w_S.y(), gave_S[4], dt_s);
  turn_S.z() = heading_.step(demand.heading_error_rad, motion.w_S.z(), gave_S[5], dt_s);
  // Convert accelerations to a wrench.
  a_S += R_WL.transpose() * a_W;
  demand.wrench.head<3>() = craft_.mass.head<3>().cwiseProduct(a_S);
  demand.wrench.tail<3>() = craft_.mass.tail<3>().cwiseProduct(turn_S);
  return demand;
}

void HelmLaw::reset() {
  for (AxisHold* hold : {&heading_, &depth_, &roll_, &pitch_, &east_, &north_}) hold->reset();
  speed_.reset();
  climb_sum_rad_ = 0;
  drift_mps_.setZero();
}

}  // namespace devices
