// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion/gait/gait_family.hpp"
#include "motion/gait/leg.hpp"
#include "motion/gait/leg_motion.hpp"

namespace motion {

/// Motion of a walk in half a period.
struct GaitStep {
  double forward_m = 0, left_m = 0, turn_rad = 0;  ///< of the feet over the body; turn: counter-clockwise
};

/// Trot with the 31 numbers of the walk "Skelliptical" of the RoboCup team rUNSWift (2005), and a stride.
///
/// On the ground a foot moves straight back at constant speed; the rest of the period it moves forward on half an
/// ellipse.  Short ramps lead into and out of the ground stroke.  Front and rear legs have their own numbers.  The body
/// tilts by the different heights of front and rear hips.  The front legs stand on the arc of the forearm, the rear
/// legs on their toes.  Numbers and shape after the documentation of the parameters and the published values of the
/// team; where the walk of the team is not limited, such as the speeds of its joints, this one is not either.
class Skelliptical final : public GaitFamily {
 public:
  enum Number : std::size_t {
    half_period,        ///< s; rounded to whole frames
    front_body_height,  ///< of the front hips above the ground, m, when it does not walk sideways
    rear_body_height,
    front_lift,  ///< height of a foot in the air, m, when it walks straight
    rear_lift,
    front_x,  ///< middle of the ground stroke, before the hip, m
    front_y,  ///< outwards of the hip
    rear_x,
    rear_y,
    front_turn_lift,  ///< as front_lift, when it turns or walks sideways
    rear_turn_lift,
    front_ground_share,  ///< share of the period on the ground
    rear_ground_share,
    front_lead_in,  ///< ramp onto the ground: share of the first half of the ground stroke
    front_down,     ///< its height as a share of the lift
    front_lead_out,
    front_up,
    rear_lead_in,
    rear_down,
    rear_lead_out,
    rear_up,
    thrust,  ///< how far a foot pushes down at the end of its ground stroke, m
    canter,  ///< amplitude of up and down of the body, twice a period, m
    side_offset,
    turn_center_x,  ///< from the middle of the hips, m
    turn_center_y,
    front_side_body_height,  ///< as front_body_height, when it walks sideways
    front_stride_ratio,      ///< stride of the front legs over that of the rear legs
    front_side_ratio,
    front_roll,     ///< share of the front stride by rolling on the arc
    front_contact,  ///< point of the arc on which it stands, rad
    stride,         ///< of half a period, m; not one of the 31
    count
  };

  explicit Skelliptical(const sim::VehicleConfig& vehicle);
  const std::vector<GaitNumber>& numbers() const override { return numbers_; }
  sim::JointMotion motion(std::span<const double> values) const override;
  /// Returns the walk with another step than that of its stride.
  sim::JointMotion motion(std::span<const double> values, const GaitStep& step, CourseLimit limit) const;

  /// Returns the numbers of the team's walk "Fast Forward" for an ERS-7, at stride 0.
  static std::vector<double> fast_forward();

  /// Place of a foot on its way.
  struct Stroke {
    double along = 0;   ///< forward, in strides
    double height = 0;  ///< in lifts
    double thrust = 0;  ///< share of the thrust
    bool on_ground = true;
  };
  /// `phase`: -1 to 1; 0 in the middle of the ground stroke, -1 and 1 at the highest point.
  static Stroke stroke_at(std::span<const double> values, bool front, double phase);
  const std::vector<Leg>& legs() const { return legs_; }
  /// Returns the postures of a leg at its phase.
  LegPosture posture_at(std::span<const double> values, const GaitStep& step, const Leg& leg, double phase) const;

 private:
  Leg with_contact(const Leg& leg, double arc_rad) const;

  std::vector<GaitNumber> numbers_;
  std::vector<Leg> legs_;
  std::string vehicle_;
  double frame_s_;
  double scale_;  ///< length of the front legs over that of an ERS-7
};

}  // namespace motion
