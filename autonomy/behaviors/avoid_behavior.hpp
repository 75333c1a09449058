// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "autonomy/behaviors/avoidance_law.hpp"
#include "autonomy/behaviors/cloned.hpp"
#include "autonomy/behaviors/drift_estimate.hpp"
#include "autonomy/behaviors/obstacle_tracks.hpp"

namespace autonomy {

/// Obstacles in the scans of a vehicle, and the law by which it avoids them.
class Avoidance {
 public:
  Avoidance(std::unique_ptr<AvoidanceLaw> law, const ObstacleTracks::Params& tracks)
      : law_(std::move(law)), tracks_(tracks) {}

  void receive(const Scan& scan, const Motion& own) { tracks_.receive(scan, own); }
  /// Returns `desired`, turned by the avoidance law if necessary.  Without a heading it is unchanged.
  Course steer(const Motion& own, const Course& desired);

 private:
  Cloned<AvoidanceLaw> law_;
  ObstacleTracks tracks_;
  DriftEstimate drift_;
};

/// Another behavior that avoids what the lidar or the forward sonar sees.
class AvoidBehavior final : public HelmBehavior {
 public:
  AvoidBehavior(std::unique_ptr<HelmBehavior> inner, const Avoidance& avoidance)
      : inner_(std::move(inner)), avoidance_(avoidance) {}
  Course steer(const Motion& own) override;
  std::unique_ptr<HelmBehavior> clone() const override { return std::make_unique<AvoidBehavior>(*this); }
  void receive_state(const std::string& vehicle, const Motion& other) override {
    inner_->receive_state(vehicle, other);
  }
  void receive_scan(const Scan& scan, const Motion& own) override { avoidance_.receive(scan, own); }
  bool finished() const override { return inner_->finished(); }
  std::string remark() const override { return inner_->remark(); }

 private:
  Cloned<HelmBehavior> inner_;
  Avoidance avoidance_;
};

}  // namespace autonomy
