// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/skelliptical.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace motion {

namespace {

using std::numbers::pi;

constexpr double ers7_reach_m = 0.14809;  // of a front leg
// Measured by rUNSWift (2005), from the knee at zero of the joint, forward and up: the arc of the forearm, and the
// point of the rear leg that touches the ground.
const sim::Vector3d arc_center_m(0.040, 0, -0.040);
constexpr double arc_radius_m = 0.065;
const sim::Vector3d toe_m(0.035, 0, -0.050);
constexpr double hip_distance_m = 0.130;

/// Number of the front legs, or the corresponding one of the rear legs.
double of_leg(std::span<const double> values, bool front, std::size_t of_front, std::size_t of_rear) {
  return values[front ? of_front : of_rear];
}

}  // namespace

Skelliptical::Skelliptical(const sim::VehicleConfig& vehicle)
    : legs_(legs_of(vehicle)),
      vehicle_(vehicle.vehicle),
      frame_s_(frame_s_of(vehicle)),
      scale_(reach_m(legs_[0]) / ers7_reach_m) {
  const std::vector<double> start = fast_forward();
  // Lengths were found for the ERS-7, and scale with the reach of the legs.
  const auto length = [&](const char* name, Number number, double low_m, double high_m) {
    numbers_.push_back({name, scale_ * low_m, scale_ * start[number], scale_ * high_m});
  };
  const auto share = [&](const char* name, Number number, double low, double high) {
    numbers_.push_back({name, low, start[number], high});
  };
  share("half_period_s", half_period, 0.12, 0.40);
  length("front_body_height_m", front_body_height, 0.060, 0.130);
  length("rear_body_height_m", rear_body_height, 0.080, 0.140);
  length("front_lift_m", front_lift, 0.005, 0.060);
  length("rear_lift_m", rear_lift, 0.005, 0.060);
  length("front_x_m", front_x, -0.020, 0.080);
  length("front_y_m", front_y, -0.005, 0.040);
  length("rear_x_m", rear_x, -0.070, 0.020);
  length("rear_y_m", rear_y, -0.005, 0.040);
  length("front_turn_lift_m", front_turn_lift, 0.005, 0.060);
  length("rear_turn_lift_m", rear_turn_lift, 0.005, 0.060);
  share("front_ground_share", front_ground_share, 0.3, 0.7);
  share("rear_ground_share", rear_ground_share, 0.3, 0.7);
  share("front_lead_in", front_lead_in, 0, 0.5);
  share("front_down", front_down, 0, 0.5);
  share("front_lead_out", front_lead_out, 0, 0.5);
  share("front_up", front_up, 0, 0.5);
  share("rear_lead_in", rear_lead_in, 0, 0.5);
  share("rear_down", rear_down, 0, 0.5);
  share("rear_lead_out", rear_lead_out, 0, 0.5);
  share("rear_up", rear_up, 0, 0.5);
  length("thrust_m", thrust, 0, 0.015);
  length("canter_m", canter, -0.010, 0.010);
  length("side_offset_m", side_offset, -0.010, 0.010);
  length("turn_centre_x_m", turn_center_x, -0.100, 0.100);
  length("turn_centre_y_m", turn_center_y, -0.100, 0.100);
  length("front_side_body_height_m", front_side_body_height, 0.060, 0.130);
  share("front_stride_ratio", front_stride_ratio, 0.5, 1.5);
  share("front_side_ratio", front_side_ratio, 0.5, 1.5);
  share("front_roll", front_roll, 0, 0.5);
  share("front_contact_rad", front_contact, -0.5, 0.5);
  length("stride_m", stride, 0.005, 0.100);
  numbers_[stride].start = scale_ * 0.02;
}

std::vector<double> Skelliptical::fast_forward() {
  return {0.176, 0.0744, 0.1195, 0.0343, 0.046,  0.0271, 0.0096, -0.0112, 0.0063, 0.020, 0.020,
          0.478, 0.59,   0.057,  0.054,  0.027,  0.041,  0.12,   0.013,   0.041,  0.056, 0.0051,
          0.003, 0,      0,      0,      0.0744, 1,      1,      0,       0,      0};
}

Skelliptical::Stroke Skelliptical::stroke_at(std::span<const double> values, bool front, double phase) {
  const double ground = of_leg(values, front, front_ground_share, rear_ground_share);
  const bool second_half = phase > 0;  // of the ground stroke, and of the way up
  const double ramp = second_half ? of_leg(values, front, front_lead_out, rear_lead_out)
                                  : of_leg(values, front, front_lead_in, rear_lead_in);
  const double ramp_height =
      second_half ? of_leg(values, front, front_up, rear_up) : of_leg(values, front, front_down, rear_down);
  const double away = std::abs(phase), flat = ground * (1 - ramp);
  Stroke stroke;
  stroke.on_ground = away <= ground;
  if (stroke.on_ground) {
    stroke.along = -phase;
    if (away > flat) stroke.height = ramp_height * (away - flat) / (ground - flat);
    if (second_half) stroke.thrust = away <= flat ? away / flat : (ground - away) / (ground - flat);
  } else {
    // Half an ellipse whose ends are those of the ground stroke.
    const double angle = (away - ground) / (1 - ground) * pi / 2;
    stroke.along = (second_half ? -ground : ground) * std::cos(angle);
    stroke.height = ramp_height + (1 - ramp_height) * std::sin(angle);
  }
  return stroke;
}

/// Returns the leg with the point on which it stands as its foot.
Leg Skelliptical::with_contact(const Leg& leg, double arc_rad) const {
  Leg standing = leg;
  const sim::Vector3d aside(0, leg.foot.y() - leg.knee.y(), 0);
  sim::Vector3d point_m = toe_m;
  // A positive angle is further up on the arc.
  if (is_front(leg)) point_m = arc_center_m + arc_radius_m * sim::Vector3d(-std::cos(arc_rad), 0, std::sin(arc_rad));
  standing.foot = leg.knee + scale_ * point_m + aside;
  standing.foot_radius_m = 0;
  return standing;
}

LegPosture Skelliptical::posture_at(std::span<const double> values, const GaitStep& step, const Leg& leg,
                                    double phase) const {
  const bool front = is_front(leg);
  const double side = side_of(leg);
  // The body tilts by the heights of its hips.  Shares of walking straight, sideways and turning mix the numbers.
  const double straight_m = std::abs(step.forward_m), sideways_m = std::abs(step.left_m);
  const double straight = straight_m + sideways_m > 0 ? straight_m / (straight_m + sideways_m) : 1;
  const double front_height_m = straight * values[front_body_height] + (1 - straight) * values[front_side_body_height];
  const double tilt_rad =
      std::asin(std::clamp((values[rear_body_height] - front_height_m) / (scale_ * hip_distance_m), -1.0, 1.0));
  const double hip_x_m = scale_ * hip_distance_m * std::cos(tilt_rad) / 2;
  // The middle of the ground stroke, from the center of the turn, level; y to the left.
  const double x_m = of_leg(values, front, front_x, rear_x), y_m = of_leg(values, front, front_y, rear_y);
  const double from_center_x_m = (front ? hip_x_m : -hip_x_m) + x_m - values[turn_center_x];
  const double from_center_y_m = leg.foot.y() + side * y_m - values[turn_center_y];
  const double turn_m = std::abs(step.turn_rad) * std::hypot(hip_x_m + values[front_x], leg.foot.y());
  const double all_m = straight_m + sideways_m + turn_m;
  const double forward = all_m > 0 ? straight_m / all_m : 1;
  // The stroke, along and turned about the center.
  const Stroke stroke = stroke_at(values, front, phase);
  const double turn_rad = stroke.along * step.turn_rad;
  double forward_m =
      stroke.along * step.forward_m + from_center_x_m * (std::cos(turn_rad) - 1) - from_center_y_m * std::sin(turn_rad);
  double left_m =
      stroke.along * step.left_m + from_center_x_m * std::sin(turn_rad) + from_center_y_m * (std::cos(turn_rad) - 1);
  double arc_rad = values[front_contact];
  if (front) {
    forward_m *= values[front_stride_ratio];
    left_m *= values[front_side_ratio];
    if (stroke.on_ground) arc_rad += values[front_roll] * forward_m / (scale_ * arc_radius_m);
    if (stroke.on_ground) forward_m *= 1 - values[front_roll];
  }
  const double lift_m = forward * of_leg(values, front, front_lift, rear_lift) +
                        (1 - forward) * of_leg(values, front, front_turn_lift, rear_turn_lift);
  const double up_m =
      stroke.height * lift_m - stroke.thrust * values[thrust] - values[canter] * std::cos(2 * pi * phase);
  // Relative to the hip and level, then in the vehicle frame, whose nose is down.
  const double level_x_m = x_m + forward_m;
  const double level_z_m = up_m - (front ? front_height_m : values[rear_body_height]);
  const double c = std::cos(tilt_rad), s = std::sin(tilt_rad);
  const sim::Vector3d from_hip(c * level_x_m - s * level_z_m, side * y_m + left_m + values[side_offset],
                               s * level_x_m + c * level_z_m);
  return with_contact(leg, arc_rad).posture_at(leg.hip + from_hip);
}

sim::JointMotion Skelliptical::motion(std::span<const double> values, const GaitStep& step, CourseLimit limit) const {
  const int half = std::max(4, static_cast<int>(std::lround(values[half_period] / frame_s_)));
  return leg_motion(vehicle_, legs_, 2 * half, frame_s_, limit, [&](const Leg& leg, int frame) {
    // Diagonal legs together.
    const int first = (leg.name == "lf" || leg.name == "rh") ? 0 : half;
    const int at = (frame + first) % (2 * half);
    return posture_at(values, step, leg, static_cast<double>(at > half ? at - 2 * half : at) / half);
  });
}

sim::JointMotion Skelliptical::motion(std::span<const double> values) const {
  return motion(values, {.forward_m = values[stride]}, CourseLimit::speed);
}

}  // namespace motion
