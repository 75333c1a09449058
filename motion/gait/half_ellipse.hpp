// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion/gait/gait_family.hpp"
#include "motion/gait/leg.hpp"

namespace motion {

/// Trot with the 12 numbers of Kohl and Stone (ICRA 2004): each foot moves on a half ellipse, straight back on the
/// ground and in an arc through the air; diagonal legs move together, the two pairs half a period apart.
class HalfEllipse final : public GaitFamily {
 public:
  enum Number : std::size_t {
    front_height,  ///< height of the front arcs, m
    front_x,       ///< center of the front loci, from straight below the hip, m
    front_y,       ///< outwards
    rear_height,
    rear_x,
    rear_y,
    length,             ///< of the loci on the ground, m
    skew,               ///< the left loci are longer by this share, the right ones shorter
    front_body_height,  ///< of the front hips above the ground, m
    rear_body_height,
    period,       ///< s; rounded to an even number of frames
    ground_share  ///< share of the period on the ground
  };

  explicit HalfEllipse(const sim::VehicleConfig& vehicle);
  const std::vector<GaitNumber>& numbers() const override { return numbers_; }
  sim::JointMotion motion(std::span<const double> values) const override;

  const std::vector<Leg>& legs() const { return legs_; }
  double frame_s() const { return frame_s_; }
  /// Returns the number of frames of a period, which is even.
  int frames(std::span<const double> values) const;
  /// Returns the desired center of a foot in the vehicle frame at its phase, from 0 to 1.
  static sim::Vector3d foot_at(std::span<const double> values, const Leg& leg, double phase);

 private:
  std::vector<GaitNumber> numbers_;
  std::vector<Leg> legs_;
  std::string vehicle_;
  double frame_s_ = 0.008;
};

}  // namespace motion
