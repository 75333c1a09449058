// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/behaviors/scan.hpp"
#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Pose and velocity of a vehicle in the plane.
struct Motion {
  std::int64_t utime = 0;
  Vector2d p_W = Vector2d::Zero();
  Vector2d v_W = Vector2d::Zero();  ///< over ground
  double yaw_rad = unknown;         ///< direction of the bow, counter-clockwise from east; unknown: not measured
};

/// Setpoints for the helm.
struct Course {
  double speed_mps = 0;
  double heading_rad = 0;  ///< counter-clockwise from east
  /// Distance for which the course is kept, such as to the next waypoint; what stands beyond is not in its way.
  double distance_m = std::numeric_limits<double>::infinity();
};

/// Decides on course and speed by the vehicle's own navigation estimate.
class HelmBehavior {
 public:
  virtual ~HelmBehavior() = default;
  virtual Course steer(const Motion& own) = 0;
  /// Returns a copy with the present state, because a program is restored with the world.
  virtual std::unique_ptr<HelmBehavior> clone() const = 0;
  /// Processes a received state of another vehicle.
  virtual void receive_state(const std::string& /*vehicle*/, const Motion& /*other*/) {}
  /// Processes a scan of a lidar or a forward sonar, and the own motion at its time.
  virtual void receive_scan(const Scan& /*scan*/, const Motion& /*own*/) {}
  virtual bool finished() const { return false; }
  /// Remark for the end of a run; empty: none.
  virtual std::string remark() const { return {}; }
};

/// Follows the legs of a route, the first of which starts at the first position.  A leg is followed by line-of-sight
/// guidance (Fossen 2021): towards the point on it that is `lookahead_m` ahead.  A cross current causes an offset of
/// lookahead * tan(drift angle).
class RouteBehavior final : public HelmBehavior {
 public:
  struct Params {
    double speed_mps = 1.5;
    double lookahead_m = 15;
    double reached_m = 5;  ///< acceptance radius of a waypoint, which also counts as reached when the line across the
                           ///< leg in it is passed
    bool loop = false;     ///< otherwise stops after the last one
  };
  /// Throws std::invalid_argument without waypoints.
  RouteBehavior(std::vector<Vector2d> waypoints_W, const Params& params);
  Course steer(const Motion& own) override;
  std::unique_ptr<HelmBehavior> clone() const override { return std::make_unique<RouteBehavior>(*this); }
  bool finished() const override { return current_ >= waypoints_W_.size(); }
  std::size_t current() const { return current_; }

 private:
  bool is_reached(const Vector2d& p_W) const;

  Params params_;
  std::vector<Vector2d> waypoints_W_;
  std::size_t current_ = 0;
  std::optional<Vector2d> from_W_;
  double heading_rad_ = 0;
};

/// Circles a point, counter-clockwise.
class CircleBehavior final : public HelmBehavior {
 public:
  struct Params {
    Vector2d center_W = Vector2d::Zero();
    double radius_m = 30;
    double speed_mps = 1.5;
    double lookahead_m = 15;
  };
  explicit CircleBehavior(const Params& params) : params_(params) {}
  Course steer(const Motion& own) override;
  std::unique_ptr<HelmBehavior> clone() const override { return std::make_unique<CircleBehavior>(*this); }

 private:
  Params params_;
};

/// Moves straight to a position, and then circles it.
class HoldBehavior final : public HelmBehavior {
 public:
  /// `hold`: the circle around the position.
  explicit HoldBehavior(const CircleBehavior::Params& hold);
  Course steer(const Motion& own) override;
  std::unique_ptr<HelmBehavior> clone() const override { return std::make_unique<HoldBehavior>(*this); }

 private:
  RouteBehavior path_;
  CircleBehavior circle_;
};

/// Keeps a position relative to another vehicle, by the last position and motion that it reported.
class FollowBehavior final : public HelmBehavior {
 public:
  struct Params {
    std::string vehicle;  ///< name of the other vehicle
    double ahead_m = 0;   ///< of the other, along its course; negative: behind
    double left_m = 30;
    double speed_max_mps = 2;
    double lookahead_m = 15;
    double catch_up_per_s = 0.05;  ///< of the distance along the course, added to the other's speed
    double discard_after_s =
        300;  ///< maximum age of the other's state, after which it stops; also for states this far ahead
  };
  explicit FollowBehavior(const Params& params) : params_(params) {}
  /// Processes a state of the other vehicle; older ones than the last are ignored, unless by more than a minute: then
  /// its clock was set.
  void receive_state(const std::string& vehicle, const Motion& other) override;
  /// Holds still until it has received a state of the other vehicle.
  Course steer(const Motion& own) override;
  std::unique_ptr<HelmBehavior> clone() const override { return std::make_unique<FollowBehavior>(*this); }
  std::string remark() const override;
  /// Returns the desired position.
  std::optional<Vector2d> place_W(std::int64_t utime) const;

 private:
  Params params_;
  std::optional<Motion> other_;
  double other_course_rad_ = 0;
};

/// Returns waypoints that cross the line between two points: `legs` of them, `amplitude_m` to its sides in turn, left
/// first, evenly spaced, and then the end of the line.
std::vector<Vector2d> zigzag(const Vector2d& from_W, const Vector2d& to_W, double amplitude_m, int legs);

}  // namespace autonomy
