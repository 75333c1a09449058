// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "autonomy/behaviors/avoidance_law.hpp"

namespace autonomy {

/// Vector field histogram VFH+ (Ulrich, Borenstein, ICRA 1998): obstacles within `keep_m` of which the vehicle must not
/// come block the sectors of a polar histogram in which they are seen; sectors that it cannot reach at its rate of turn
/// without touching one are blocked too.  Of the openings it takes the direction with the lowest weighted sum of the
/// angles to the desired heading, to its own heading and to its last choice, 5 : 2 : 2.  Obstacles count as still.
class VectorFieldHistogram final : public AvoidanceLaw {
 public:
  static constexpr int sectors = 72;

  explicit VectorFieldHistogram(const AvoidanceParams& params) : params_(params) {}
  Course steer(const Motion& own, const Vector2d& drift_W, const Course& desired,
               std::span<const Obstacle> obstacles) override;
  std::unique_ptr<AvoidanceLaw> clone() const override { return std::make_unique<VectorFieldHistogram>(*this); }

  /// Returns which sectors are blocked by obstacles within `range_m`; sector i is centered on the direction 2 pi i /
  /// sectors from east.
  std::array<bool, sectors> blocked(const Motion& own, double speed_mps, double range_m,
                                    std::span<const Obstacle> obstacles) const;

 private:
  AvoidanceParams params_;
  double last_rad_ = unknown;  ///< direction chosen last
};

}  // namespace autonomy
