// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/mapping/mapper.hpp"

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

namespace {

Pose2 moved(const Pose2& pose, const Increment& by) {
  return {pose.p_W + turned({by.forward_m, by.left_m}, pose.yaw_rad), sim::wrap_angle(pose.yaw_rad + by.turn_rad)};
}

/// Number of points in known cells from which on their agreement with the map counts.
constexpr int enough_known = 20;

Vector2d placed(const Pose2& pose, const Vector2d& p_B) {
  return pose.p_W + turned(p_B, pose.yaw_rad);
}

}  // namespace

Mapper::Mapper(const Params& params)
    : params_(params), map_(params.map), matcher_(params.matcher), pose_(params.start), odometer_(Pose2{}) {}

void Mapper::receive(const shoal::odometry_t& odometry) {
  constexpr double farthest_m = 1e6, fastest = 1e3;
  if (std::hypot(odometry.x_m, odometry.y_m) > farthest_m || std::abs(odometry.theta_rad) > farthest_m ||
      std::abs(odometry.forward_mps) > fastest || std::abs(odometry.turn_radps) > fastest)
    throw shoal::MessageError("odometry must be within 1e6 m, 1e6 rad, 1e3 m/s and 1e3 rad/s");
  odometry_ = odometry;
}

void Mapper::receive(const shoal::planar_lidar_t& scan) {
  scan_ = scan;
}

Mapper::Beams Mapper::beams_of(const shoal::planar_lidar_t& scan) const {
  Beams beams;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range_m = static_cast<double>(scan.ranges[i]);
    if (!(range_m > 0)) continue;
    const bool hit = range_m < 0.99 * params_.lidar_range_m && range_m <= params_.use_range_m;
    const double angle_rad =
        static_cast<double>(scan.rad0) + static_cast<double>(i) * static_cast<double>(scan.radstep);
    const double length_m = std::min(range_m, params_.use_range_m);
    beams.ends_B.push_back(placed(params_.lidar, length_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad))));
    beams.hits.push_back(hit ? 1 : 0);
    if (hit) beams.points_B.push_back(beams.ends_B.back());
  }
  return beams;
}

Increment Mapper::moved_since_scan() {
  // Odometry of the time of the scan, by its speed since the last report.
  const double dt_s = std::clamp(seconds(scan_->utime - odometry_->utime), -1.0, 1.0);
  const double theta_rad = odometry_->theta_rad + odometry_->turn_radps * dt_s;
  const Vector2d p = Vector2d(odometry_->x_m, odometry_->y_m) + turned({odometry_->forward_mps * dt_s, 0}, theta_rad);
  return odometer_.update(p, theta_rad);
}

std::optional<shoal::estimate_t> Mapper::step() {
  if (!scan_ || !odometry_) return std::nullopt;
  const Increment by = moved_since_scan();
  const Beams beams = beams_of(*scan_);
  utime_ = scan_->utime;
  scan_.reset();
  if (lost_) {
    pose_ = moved(pose_, by);
    for (Sight& sight : collected_)
      for (Vector2d* point : {&sight.from_B, &sight.end_B})
        *point = turned(*point - Vector2d(by.forward_m, by.left_m), -by.turn_rad);
    search(beams);
  } else {
    track(beams, by);
  }
  return estimate();
}

void Mapper::track(const Beams& beams, const Increment& by) {
  const Pose2 predicted = moved(pose_, by);
  pose_ = predicted;
  if (!has_map_) {
    first_utime_ = utime_;
    return insert(beams);
  }
  // A vehicle at rest is matched only from time to time, and when the scan fits worse.
  const bool rests = std::hypot(by.forward_m, by.left_m) < 0.001 && std::abs(by.turn_rad) < 0.0005;
  const double score = rests ? score_of(map_, beams.points_B, predicted) : 0;
  if (rests && score > 0.9 * still_score_ && seconds(utime_ - matched_utime_) < params_.insert_s) return;
  // Match, unless the scan contradicts the map.
  const ScanMatch match = matcher_.match(map_, beams.points_B, predicted);
  if (agreement(beams.points_B, match.pose).value_or(1) < params_.min_agreement) {
    if (++bad_scans_ < params_.max_bad_scans) return;
    lost_ = true;
    ++times_lost_;
    collected_.clear();
    next_search_s_ = 0;
    return;
  }
  bad_scans_ = 0;
  pose_ = match.pose;
  still_score_ = match.score;
  matched_utime_ = utime_;
  const bool far = (pose_.p_W - inserted_.p_W).norm() >= params_.insert_m ||
                   std::abs(sim::wrap_angle(pose_.yaw_rad - inserted_.yaw_rad)) >= params_.insert_rad;
  if (far || seconds(utime_ - inserted_utime_) >= params_.insert_s) insert(beams);
}

std::optional<double> Mapper::agreement(const std::vector<Vector2d>& points_B, const Pose2& pose) const {
  constexpr double near_something = 0.2;
  int known = 0, near = 0;
  for (const Vector2d& point : points_B) {
    const Vector2d p_W = placed(pose, point);
    const bool is_near = map_.field(p_W) > near_something;
    if (!is_near && !map_.is_known(p_W)) continue;
    ++known;
    near += is_near ? 1 : 0;
  }
  return known < enough_known ? std::nullopt : std::optional(static_cast<double>(near) / known);
}

void Mapper::search(const Beams& beams) {
  // It may be where it was: something large that is new stood before the lidar.
  const ScanMatch here = matcher_.match(map_, beams.points_B, pose_);
  if (agreement(beams.points_B, here.pose).value_or(0) >= params_.certain_agreement) {
    lost_ = false;
    bad_scans_ = 0;
    pose_ = here.pose;
    return;
  }
  // Collect scans from different poses, with fewer points.
  constexpr double apart_m = 0.5, apart_rad = 0.5;
  constexpr std::size_t every = 4, max_points = 225, min_points = 80;
  const bool differs = collected_.empty() || (pose_.p_W - collected_at_.p_W).norm() > apart_m ||
                       std::abs(sim::wrap_angle(pose_.yaw_rad - collected_at_.yaw_rad)) > apart_rad;
  if (differs && collected_.size() < max_points) {
    for (std::size_t i = 0; i < beams.points_B.size(); i += every)
      collected_.push_back({params_.lidar.p_W, beams.points_B[i]});
    collected_at_ = pose_;
  }
  if (collected_.size() < min_points || seconds(utime_ - searched_utime_) < next_search_s_) return;
  searched_utime_ = utime_;
  next_search_s_ = std::clamp(2 * next_search_s_, params_.search_s, params_.max_search_s);
  const bool complete = collected_.size() >= max_points;
  const auto found = search_map(map_, collected_, params_.accept_score);
  if (complete) collected_.clear();
  const double lead = complete ? params_.last_lead : params_.accept_lead;
  if (!found || found->best.score < found->other_score + lead) return;
  lost_ = false;
  bad_scans_ = 0;
  pose_ = found->best.pose;
  still_score_ = 0;
}

void Mapper::insert(const Beams& beams) {
  std::vector<Vector2d> ends_W;
  ends_W.reserve(beams.ends_B.size());
  for (const Vector2d& end : beams.ends_B) ends_W.push_back(placed(pose_, end));
  map_.insert(placed(pose_, params_.lidar.p_W), ends_W, beams.hits, seconds(utime_ - first_utime_));
  has_map_ = true;
  inserted_ = pose_;
  inserted_utime_ = utime_;
}

shoal::estimate_t Mapper::estimate() const {
  // Of the grid and the noise of a scan; lost, it can be anywhere in the map.
  const double std_m = lost_ ? 10 : 0.03;
  shoal::estimate_t message{};
  message.utime = utime_;
  message.position_m[0] = pose_.p_W.x();
  message.position_m[1] = pose_.p_W.y();
  message.covariance_m2[0] = message.covariance_m2[4] = squared(std_m);
  message.covariance_m2[8] = 1;
  message.yaw_rad = pose_.yaw_rad;
  message.clock_error_s = unknown;
  return message;
}

shoal::occupancy_grid_t Mapper::map_message() const {
  shoal::occupancy_grid_t message{};
  message.utime = utime_;
  message.cell_m = map_.params().cell_m;
  message.origin_m[0] = map_.params().low_W.x();
  message.origin_m[1] = map_.params().low_W.y();
  message.width = map_.columns();
  message.height = map_.rows();
  message.ncells = message.width * message.height;
  message.cells.reserve(static_cast<std::size_t>(message.ncells));
  for (int row = 0; row < map_.rows(); ++row)
    for (int column = 0; column < map_.columns(); ++column)
      message.cells.push_back(static_cast<std::int8_t>(map_.percent(column, row, seconds(utime_ - first_utime_))));
  return message;
}

}  // namespace autonomy
