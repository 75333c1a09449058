// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "devices/drive/wheel_geometry.hpp"
#include "devices/drive/wheel_sides.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/odometry_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

constexpr std::int64_t max_ticks = 1'000'000'000'000'000'000;

/// Converts to whole ticks with saturation, because a restored angle or an unbounded error may be any number.
std::int64_t whole_ticks(double ticks) {
  constexpr auto limit = static_cast<double>(max_ticks);
  return static_cast<std::int64_t>(std::floor(std::fmin(std::fmax(ticks, -limit), limit)));
}

}  // namespace

void Odometry::Params::read(sim::ParamReader& in) {
  in.require("left_joint");
  in.read_reference("left_joint", left_joint, "joint", "hinge of the left wheel");
  in.require("right_joint");
  in.read_reference("right_joint", right_joint, "joint", "hinge of the right wheel");
  in.read("wheel_radius_m", wheel_radius_m, sim::above(0), "assumed radius of the wheels; unset: as in the vehicle");
  in.read("track_m", track_m, sim::above(0), "assumed distance between the wheels; unset: as given by the joints");
  in.read("ticks_per_revolution", ticks_per_revolution, sim::at_least(1), "encoder ticks in one turn of a wheel");
  in.read("noise", noise, "error of the angle a wheel turned between two samples, rad; each has one, also at rest");
}

Odometry::Odometry(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      left_(wheel_joint(context, params.left_joint)),
      right_(wheel_joint(context, params.right_joint)),
      noise_(context, params, 2),
      X_W0_(context.vehicle.X_WV()) {
  const sim::VehicleConfig& vehicle = context.vehicle.config();
  const LengthOfDevice radius{"wheel_radius_m", params.wheel_radius_m,
                              wheel_radius_m_of(vehicle, {params.left_joint, params.right_joint}), 0.1};
  const LengthOfDevice track{"track_m", params.track_m, track_m_of(vehicle, {params.left_joint}, {params.right_joint})};
  wheel_radius_m_ = radius.value_m();
  track_m_ = track.value_m();
  if (!(track_m_ > 0)) refuse(context, "'track_m' is needed: its wheels are in one place");
  // Assumed lengths may differ, as with worn tires.  The effective track of a skid-steered rover is wider.
  const AllowedRatio miscalibrated{0.9, 1.1};
  const bool scrubs = std::any_of(vehicle.devices.begin(), vehicle.devices.end(),
                                  [](const sim::DeviceConfig& device) { return device.type == "skid_steer"; });
  check_length(context, radius, miscalibrated, "it estimates {} times the distance", as_it_is);
  if (!scrubs || *track.real_m > track_m_)
    check_length(context, track, miscalibrated, "it estimates {} times the turn", inverse);
  warn_of_sides(context, {"left_joint", {params.left_joint}}, {"right_joint", {params.right_joint}});
}

void Odometry::measure(const sim::SenseContext& context) {
  const sim::Pose X_0V = X_W0_.inverse() * context.vehicle.X_WV();
  const double yaw = sim::yaw_of(X_0V.linear());
  // The angle counts full turns, as a sum of wheel ticks does.
  truth_theta_rad_ += sim::wrap_angle(yaw - truth_theta_rad_);
  const sim::Matrix3d R_VW = context.vehicle.X_WV().linear().transpose();
  reading_.x_m = X_0V.translation().x();
  reading_.y_m = X_0V.translation().y();
  reading_.theta_rad = truth_theta_rad_;
  reading_.forward_mps = (R_VW * context.vehicle.base().v_WB_W()).x();
  reading_.turn_radps = context.vehicle.base().w_WB_W().z();
  reading_.left_ticks = reckoned_.left_ticks;
  reading_.right_ticks = reckoned_.right_ticks;
}

void Odometry::disturb(double dt_s, sim::Random& random) {
  // Angles of the wheels since the last sample, with noise.
  const double angles[2] = {left_.position(left_.axes() - 1), right_.position(right_.axes() - 1)};
  double turned[2] = {angles[0] - wheel_rad_[0], angles[1] - wheel_rad_[1]};
  noise_.apply(std::span<double>(turned), dt_s, random);
  // Convert to whole ticks.
  const double rad_per_tick = 2 * std::numbers::pi / params_.ticks_per_revolution;
  std::int64_t ticks[2];
  for (int side = 0; side < 2; ++side) {
    wheel_rad_[side] = angles[side];
    believed_rad_[side] += turned[side];
    ticks[side] = whole_ticks(believed_rad_[side] / rad_per_tick);
  }
  // Distance and rotation of the vehicle.
  const double m_per_tick = rad_per_tick * wheel_radius_m_;
  const double left_m = static_cast<double>(ticks[0] - reckoned_.left_ticks) * m_per_tick;
  const double right_m = static_cast<double>(ticks[1] - reckoned_.right_ticks) * m_per_tick;
  const double forward_m = 0.5 * (left_m + right_m);
  const double turn_rad = (right_m - left_m) / track_m_;
  // Integrate the pose along an arc of constant curvature: its chord at the mean heading.
  const double half = 0.5 * turn_rad;
  const double chord_m = std::abs(half) < 1e-9 ? forward_m : forward_m * std::sin(half) / half;
  reckoned_.x_m += chord_m * std::cos(reckoned_.theta_rad + half);
  reckoned_.y_m += chord_m * std::sin(reckoned_.theta_rad + half);
  reckoned_.theta_rad += turn_rad;
  reckoned_.forward_mps = dt_s > 0 ? forward_m / dt_s : 0;
  reckoned_.turn_radps = dt_s > 0 ? turn_rad / dt_s : 0;
  reckoned_.left_ticks = ticks[0];
  reckoned_.right_ticks = ticks[1];
  reading_ = reckoned_;
}

void Odometry::visit_state(sim::StateArchive& archive) {
  archive(X_W0_, truth_theta_rad_, wheel_rad_, believed_rad_, reading_, reckoned_, noise_);
  for (const std::int64_t ticks : {reckoned_.left_ticks, reckoned_.right_ticks})
    if (archive.restoring() && (ticks > max_ticks || ticks < -max_ticks))
      archive.fail("a wheel that turned farther than can be counted");
}

void fill(const Odometry& odometry, shoal::odometry_t& message) {
  const Odometry::Reading& reading = odometry.reading();
  message.x_m = reading.x_m;
  message.y_m = reading.y_m;
  message.theta_rad = reading.theta_rad;
  message.forward_mps = reading.forward_mps;
  message.turn_radps = reading.turn_radps;
  message.left_ticks = reading.left_ticks;
  message.right_ticks = reading.right_ticks;
}

SHOAL_SENSOR("odometry", Odometry, shoal::odometry_t);

}  // namespace devices
