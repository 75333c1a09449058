// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/behaviors/drift_estimate.hpp"
#include "autonomy/behaviors/helm_behavior.hpp"

namespace autonomy {

/// Shapes of a formation, for `formation`: line (abreast), column and vee.
std::vector<std::string> formation_names();
/// Returns the place in a formation relative to its leader, ahead and to the left.  Odd places of a line and a vee are
/// on the left, even ones on the right.  Throws std::invalid_argument for an unknown name or a place below 1.
Vector2d formation_offset_m(const std::string& name, int place, double spacing_m);

/// Keeps a place in a formation by the states that its leader sends, by constant bearing guidance (Breivik, Hovstein,
/// Fossen, Straight-line target tracking for unmanned surface vehicles, MIC 29(4), 2008): with the error e, from here
/// to the place, the velocity over ground is v = v_leader + U e / sqrt(|e|^2 + D^2).  The motion of the water is
/// subtracted from it.  The vehicle does not turn around to fall back: it slows down.
class FormationBehavior final : public HelmBehavior {
 public:
  struct Params {
    std::string leader;
    Vector2d offset_m = Vector2d::Zero();  ///< ahead and to the left, by the course of the leader
    double speed_max_mps = 2;
    double speed_min_mps = 0.3;   ///< slowest speed through the water
    double approach_mps = 1.2;    ///< U
    double distance_m = 9;        ///< D
    double discard_after_s = 60;  ///< maximum age of the state of the leader, after which it stops
  };
  explicit FormationBehavior(const Params& params) : params_(params) {}
  void receive_state(const std::string& vehicle, const Motion& other) override;
  /// Stops until it has received a state of its leader.
  Course steer(const Motion& own) override;
  std::unique_ptr<HelmBehavior> clone() const override { return std::make_unique<FormationBehavior>(*this); }
  std::string remark() const override;
  /// Returns the place at a time.
  std::optional<Vector2d> place_W(std::int64_t utime) const;

 private:
  Course course_for(const Motion& own) const;

  Params params_;
  DriftEstimate drift_;
  std::optional<Motion> leader_;
  double leader_course_rad_ = 0;
};

}  // namespace autonomy
