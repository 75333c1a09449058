// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion/gait/gait_family.hpp"
#include "motion/gait/leg.hpp"

namespace motion {

/// Trot by coupled oscillators, as of a central pattern generator (Ijspeert 2008, Neural Networks 21), in their steady
/// state, with 8 numbers.  The phases of diagonal legs are equal, those of the two pairs half a period apart.  Each
/// swing is a sine of its phase, each knee bends by a raised cosine with its own phase; flaps are at 0.
class Cpg final : public GaitFamily {
 public:
  enum Number : std::size_t {
    period,           ///< s; rounded to an even number of frames
    swing_amplitude,  ///< rad
    knee_amplitude,   ///< rad, from the least to the greatest bend
    knee_phase,       ///< greatest bend of a knee after the middle of its leg's forward swing, share of the period
    front_swing,      ///< middle of the swing, rad, forward
    rear_swing,       ///< rad, forward
    front_knee,       ///< least bend, rad
    rear_knee
  };

  explicit Cpg(const sim::VehicleConfig& vehicle);
  const std::vector<GaitNumber>& numbers() const override { return numbers_; }
  sim::JointMotion motion(std::span<const double> values) const override;
  /// Returns the posture of a leg at its phase, from 0 to 1; at 0 it is in the middle of its swing forward.
  static LegPosture posture_at(std::span<const double> values, const Leg& leg, double phase);
  const std::vector<Leg>& legs() const { return legs_; }

 private:
  std::vector<GaitNumber> numbers_;
  std::vector<Leg> legs_;
  std::string vehicle_;
  double frame_s_;
};

}  // namespace motion
