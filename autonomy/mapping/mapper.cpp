// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/mapper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/base/math.hpp"

namespace autonomy {
namespace {

/// Scans of the survey that do not close a loop with the present one.
constexpr std::size_t recent_scans = 20;

struct OdometryStd {
  double m, rad;
};

/// Standard deviation of a move by odometry: of any move, and as a share of it.
OdometryStd std_of(const Increment& by) {
  constexpr double min_m = 0.01, share_m = 0.02, min_rad = 0.01, share_rad = 0.03;
  return {min_m + share_m * std::hypot(by.forward_m, by.left_m), min_rad + share_rad * std::abs(by.turn_rad)};
}

}  // namespace

Mapper::Mapper(const Params& params)
    : params_(params),
      map_(params.map),
      matcher_(params.matcher),
      pose_(params.start),
      odometer_(Pose2{}),
      search_(params.search) {}

void Mapper::receive(const shoal::odometry_t& odometry) {
  check_reachable(odometry);
  odometry_ = odometry;
}

void Mapper::receive(const shoal::planar_lidar_t& scan) {
  scan_ = scan;
}

std::optional<shoal::estimate_t> Mapper::step() {
  if (!scan_ || !odometry_) return std::nullopt;
  Increment by = moved_until(scan_->utime, *odometry_, odometer_);
  // Whatever it moved while odometry was silent is in no increment, neither then nor when odometry is back.
  constexpr double max_gap_s = 2;
  const bool silent = std::abs(seconds(scan_->utime - odometry_->utime)) > max_gap_s;
  const bool missed = silent || missed_odometry_;
  missed_odometry_ = silent;
  if (missed) {
    by = {};
    covariance_ += loose_covariance();
  }
  const double dt_s = std::min(seconds(scan_->utime - utime_), max_gap_s);
  const bool rests = !missed && std::hypot(by.forward_m, by.left_m) < params_.rest_mps * dt_s &&
                     std::abs(by.turn_rad) < params_.rest_radps * dt_s;
  if (rests) by = {};
  left_ = has_map_ && (left_ || !rests);
  if (!left_) first_scan_.add(*scan_);
  const Beams beams = beams_of(*scan_, params_.lidar);
  utime_ = scan_->utime;
  scan_.reset();
  if (lost_) {
    search(beams, by);
  } else {
    track(beams, by, rests);
  }
  return estimate();
}

void Mapper::predict(const Increment& by) {
  const Vector2d moved_W = turned({by.forward_m, by.left_m}, pose_.yaw_rad);
  pose_ = moved(pose_, by);
  since_survey_ = moved(since_survey_, by);
  Eigen::Matrix3d turns = Eigen::Matrix3d::Identity();
  turns.topRightCorner<2, 1>() = left_of(moved_W);
  covariance_ = turns * covariance_ * turns.transpose();
  const OdometryStd std = std_of(by);
  covariance_.diagonal() += Eigen::Vector3d(squared(std.m), squared(std.m), squared(std.rad));
}

void Mapper::track(const Beams& beams, const Increment& by, bool rests) {
  if (!has_map_) {
    first_utime_ = utime_;
    return survey(beams);
  }
  predict(by);
  // A vehicle at rest is matched only from time to time, and when the scan fits worse.
  const double score = rests ? score_of(map_, beams.points_B, pose_) : 0;
  if (rests && score > 0.9 * still_score_ && seconds(utime_ - matched_utime_) < params_.insert_s) return;
  // Match, unless the scan contradicts the map.  Beams may pass through what has gone, such as a truck beside the
  // vehicle, when they end where something is.
  const ScanMatch match = matcher_.match(map_, beams.points_B, pose_, covariance_.inverse());
  const Fit fit = fit_of(map_, beams, match.pose, params_.min_near);
  if (beams.points_B.size() >= min_judged_points && fit.ends_near() < params_.min_near &&
      fit.evidence() < (surveys_ ? params_.min_survey_evidence : params_.min_evidence)) {
    if (++bad_scans_ < params_.max_bad_scans) return;
    if (surveys_) end_survey();
    lost_ = true;
    ++times_lost_;
    search_ = PlaceSearch(params_.search);
    return;
  }
  bad_scans_ = 0;
  pose_ = match.pose;
  covariance_ = (covariance_.inverse() + matcher_.information_of(map_, beams.points_B, pose_)).inverse();
  still_score_ = match.score;
  matched_utime_ = utime_;
  const double away_m = (pose_.p_W - inserted_.p_W).norm();
  const double turned_rad = std::abs(sim::wrap_angle(pose_.yaw_rad - inserted_.yaw_rad));
  const bool far = away_m >= (surveys_ ? params_.survey_m : params_.insert_m) ||
                   turned_rad >= (surveys_ ? params_.survey_rad : params_.insert_rad);
  if (surveys_ && far)
    survey(beams);
  else if (far || seconds(utime_ - inserted_utime_) >= params_.insert_s)
    insert(beams, pose_, utime_);
}

void Mapper::search(const Beams& beams, const Increment& by) {
  predict(by);
  search_.move(by);
  if (beams.points_B.size() < min_judged_points) return;
  // The vehicle may still be where it was, with something large and new in front of the lidar.
  const ScanMatch here = matcher_.match(map_, beams.points_B, pose_, loose_covariance().inverse());
  std::optional<Pose2> found;
  if (fit_of(map_, beams, here.pose).evidence() >= params_.certain_evidence)
    found = here.pose;
  else
    found = search_.look(map_, matcher_, beams, pose_);
  if (!found) return;
  lost_ = false;
  bad_scans_ = 0;
  pose_ = *found;
  covariance_ = loose_covariance();
  still_score_ = 0;
}

void Mapper::survey(const Beams& beams) {
  constexpr double near_m = 6, near_rad = 1.2, meters_per_rad = 2;
  const std::size_t last = surveyed_.size();
  graph_.add_pose(pose_);
  surveyed_.push_back(
      {std::make_shared<const Beams>(beams), std::make_shared<const Outline>(beams.points_B), utime_, pose_});
  if (last == 1) {
    const Beams first = beams_of(*first_scan_.scan(), params_.lidar);
    surveyed_[0].beams = std::make_shared<const Beams>(first);
    surveyed_[0].outline = std::make_shared<const Outline>(first.points_B);
    first_scan_.clear();
  }
  if (last > 0) {
    Alignment by_odometry{since_survey_, Eigen::Matrix3d::Zero()};
    // The errors of odometry are the same in each step, so that they do not average out.
    const OdometryStd std = std_of({3 * since_survey_.p_W.norm(), 0, since_survey_.yaw_rad});
    by_odometry.information.diagonal() << 1 / squared(std.m), 1 / squared(std.m), 1 / squared(std.rad);
    graph_.add_measurement(static_cast<int>(last) - 1, static_cast<int>(last), by_odometry);
    close_loop(last - 1);
  }
  // Further scans near it: some of the last ones, farther from each other so that small errors do not add up, and some
  // of earlier rounds.
  std::vector<std::pair<double, std::size_t>> close;
  for (std::size_t i = 0; i + 1 < last; ++i) {
    const Pose2 away = seen_from(graph_.poses()[i], pose_);
    if (away.p_W.norm() < near_m && std::abs(away.yaw_rad) < near_rad)
      close.emplace_back(away.p_W.norm() + meters_per_rad * std::abs(away.yaw_rad), i);
  }
  std::sort(close.begin(), close.end());
  struct Taken {
    std::size_t max, count = 0;
    double apart, last = 0;
  } recent{.max = 3, .apart = 1.3}, earlier{.max = 4, .apart = 0.3};
  for (const auto& [distance, other] : close) {
    Taken& taken = other + recent_scans > last ? recent : earlier;
    if (taken.count == taken.max || distance < taken.last + taken.apart || !close_loop(other)) continue;
    ++taken.count;
    taken.last = distance;
  }
  since_survey_ = {};
  graph_.optimize(2);
  pose_ = graph_.poses().back();
  insert(beams, pose_, utime_);
  surveyed_.back().drawn = pose_;
  double max_moved_m = 0;
  for (std::size_t i = 0; i < surveyed_.size(); ++i)
    max_moved_m = std::max(max_moved_m, (graph_.poses()[i].p_W - surveyed_[i].drawn.p_W).norm());
  if (static_cast<int>(surveyed_.size()) >= params_.survey_scans)
    end_survey();
  else if (max_moved_m > params_.redraw_m)
    redraw();
}

bool Mapper::close_loop(std::size_t other) {
  constexpr double gate_m = 0.4, loop_gate_m = 1, farthest_rad = 0.3;
  const std::size_t last = surveyed_.size() - 1;
  // After a loop the drift is larger than between neighboring scans.
  const double max_m = other + recent_scans > last ? gate_m : loop_gate_m;
  const Pose2 guess = seen_from(graph_.poses()[other], graph_.poses()[last]);
  const auto aligned = align(*surveyed_[other].outline, *surveyed_[last].outline, guess, max_m);
  // A match far from the guess is more likely a similar wall than a large drift.
  if (!aligned) return false;
  const Pose2 off = seen_from(guess, aligned->pose);
  if (off.p_W.norm() > max_m || std::abs(off.yaw_rad) > farthest_rad) return false;
  graph_.add_measurement(static_cast<int>(other), static_cast<int>(last), *aligned);
  return true;
}

void Mapper::end_survey() {
  constexpr int iterations = 10;
  const Pose2 since = seen_from(graph_.poses().back(), pose_);
  graph_.optimize(iterations);
  redraw();
  map_.anchor();
  pose_ = composed(graph_.poses().back(), since);
  surveys_ = false;
  surveyed_.clear();
  graph_ = PoseGraph();
}

void Mapper::redraw() {
  map_ = OccupancyMap(params_.map);
  for (std::size_t i = 0; i < surveyed_.size(); ++i) {
    surveyed_[i].drawn = graph_.poses()[i];
    insert(*surveyed_[i].beams, surveyed_[i].drawn, surveyed_[i].utime);
  }
}

void Mapper::insert(const Beams& beams, const Pose2& pose, std::int64_t utime) {
  const std::int64_t since = std::max<std::int64_t>(0, utime - first_utime_);  // a clock may be set back
  map_.insert(placed(pose, beams.sensor_B), ends_W_of(beams, pose), beams.hits, seconds(since));
  has_map_ = true;
  inserted_ = pose;
  inserted_utime_ = utime;
}

shoal::estimate_t Mapper::estimate() const {
  // The covariance is at least that of the grid; a lost vehicle can be anywhere in the map.
  constexpr double grid_std_m = 0.02, lost_std_m = 10;
  const double std_m = lost_ ? lost_std_m : grid_std_m;
  return planar_estimate(utime_, pose_,
                         covariance_.topLeftCorner<2, 2>() + squared(std_m) * Eigen::Matrix2d::Identity());
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

namespace {

Eigen::ArrayXd ranges_of(const shoal::planar_lidar_t& scan) {
  return Eigen::Map<const Eigen::ArrayXf>(scan.ranges.data(), static_cast<Eigen::Index>(scan.ranges.size()))
      .cast<double>();
}

}  // namespace

void MeanScan::add(const shoal::planar_lidar_t& scan) {
  if (!first_) {
    first_ = scan;
    off_m_ = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(scan.ranges.size()));
    counts_ = Eigen::ArrayXi::Zero(off_m_.size());
  }
  if (scan.ranges.size() != first_->ranges.size() || scan.rad0 != first_->rad0 || scan.radstep != first_->radstep)
    return;
  constexpr double max_off_m = 0.2;
  const Eigen::ArrayXd off_m = ranges_of(scan) - ranges_of(*first_);
  // A beam at an edge jumps between two surfaces; only readings near the first one are averaged.
  const auto counts = off_m.abs() <= max_off_m;
  off_m_ += counts.select(off_m, 0);
  counts_ += counts.cast<int>();
  ++count_;
}

std::optional<shoal::planar_lidar_t> MeanScan::scan() const {
  constexpr double min_share = 0.9;
  if (!first_) return std::nullopt;
  shoal::planar_lidar_t scan = *first_;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const auto beam = static_cast<Eigen::Index>(i);
    // A beam that saw something else too often is dropped (range 0).
    scan.ranges[i] = counts_[beam] < min_share * count_
                         ? 0
                         : static_cast<float>(static_cast<double>(scan.ranges[i]) + off_m_[beam] / counts_[beam]);
  }
  return scan;
}

}  // namespace autonomy
