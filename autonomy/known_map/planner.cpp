// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/planner.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "shoal/message_codec.hpp"

namespace autonomy {

namespace {

std::string text_of(const Vector2d& p_W) {
  return fmt::format("({:.1f}, {:.1f})", p_W.x(), p_W.y());
}

}  // namespace

void Planner::receive(const shoal::occupancy_grid_t& map) {
  const GridFrame fine = frame_of(map);
  const int side = std::max(1, static_cast<int>(std::lround(params_.cell_m / fine.cell_m)));
  CoarseMap coarse{{fine.origin_W, side * fine.cell_m, (fine.columns + side - 1) / side, (fine.rows + side - 1) / side},
                   {}};
  // The worst of the cells merged into one wins: occupied before unknown before free.
  coarse.cells.assign(coarse.frame.size(), 0);
  for (int row = 0; row < fine.rows; ++row)
    for (int column = 0; column < fine.columns; ++column) {
      const int percent = map.cells[fine.index(column, row)];
      std::int8_t& cell = coarse.cells[coarse.frame.index(column / side, row / side)];
      if (percent >= occupied_percent)
        cell = 1;
      else if (cell == 0 && (percent < 0 || percent > free_percent))
        cell = -1;
    }
  if (map_ && map_->cells == coarse.cells && map_->frame == coarse.frame) return;
  if (map_ && !(map_->frame == coarse.frame)) {
    seen_.reset();
    seen_before_.clear();
  }
  map_ = std::make_shared<const CoarseMap>(std::move(coarse));
  is_due_ = true;
}

void Planner::receive(const shoal::planar_lidar_t& scan) {
  // The estimate at a scan comes after the next ones.  Floating point, because a difference of integers may overflow.
  constexpr double kept_us = 3e6;
  constexpr std::size_t max_kept = 1000;
  scans_.push_back(scan);
  const auto is_old = [&](const shoal::planar_lidar_t& each) {
    return !(std::abs(static_cast<double>(scan.utime) - static_cast<double>(each.utime)) < kept_us);
  };
  while (scans_.size() > max_kept || is_old(scans_.front())) scans_.pop_front();
}

void Planner::receive(const shoal::estimate_t& estimate) {
  constexpr double farthest_m = 1e7;
  for (const double value : {estimate.position_m[0], estimate.position_m[1]})
    if (std::abs(value) > farthest_m)
      throw shoal::MessageError(fmt::format("'position_m' must be within {:g} m, got {:g}", farthest_m, value));
  estimate_ = estimate;
}

void Planner::receive(const shoal::waypoints_command_t& goals) {
  goals_W_ = path_of(goals);
  loop_ = goals.loop != 0;
  current_ = 0;
  is_due_ = true;
  no_path_since_.reset();
}

void Planner::see(const Pose2& pose) {
  const auto scan = std::find_if(scans_.begin(), scans_.end(),
                                 [&](const shoal::planar_lidar_t& each) { return each.utime == estimate_->utime; });
  if (scan == scans_.end()) return;
  ++used_scans_;
  if (!seen_) {
    const GridFrame& frame = map_->frame;
    OccupancyMap::Params params;
    params.low_W = frame.origin_W;
    params.high_W = frame.origin_W + frame.cell_m * Vector2d(frame.columns, frame.rows);
    params.cell_m = frame.cell_m;
    params.dwell_s = params.min_dwell_s = params_.memory_s;
    // Two echoes of what was free for long make it occupied.
    params.hit = 2;
    params.miss = 0.6;
    params.max_log_odds = 2.5;
    seen_.emplace(params);
    first_seen_utime_ = scan->utime;
  }
  seen_before_.push_back(*seen_);
  constexpr std::size_t untrusted_scans = 5;
  if (seen_before_.size() > untrusted_scans) seen_before_.pop_front();
  const Beams beams = beams_of(*scan, params_.lidar);
  seen_->insert(placed(pose, beams.sensor_B), ends_W_of(beams, pose), beams.hits,
                seconds(std::max<std::int64_t>(0, scan->utime - first_seen_utime_)));
  scans_.erase(scans_.begin(), scan + 1);
}

PlanGrid Planner::grid() const {
  PlanGrid grid{map_->frame, {}, std::vector<char>(map_->cells.size())};
  std::vector<char> occupied(map_->cells.size());
  const double now_s = seconds(std::max<std::int64_t>(0, estimate_->utime - first_seen_utime_));
  for (int row = 0; row < grid.frame.rows; ++row)
    for (int column = 0; column < grid.frame.columns; ++column) {
      const std::size_t cell = grid.frame.index(column, row);
      const int percent = seen_ ? seen_->percent(column, row, now_s) : OccupancyMap::unknown_percent;
      const bool is_seen = percent >= occupied_percent || (percent >= 0 && percent <= free_percent);
      // What the lidar has seen counts before the map, which may be old.
      occupied[cell] = (is_seen ? percent >= occupied_percent : map_->cells[cell] == 1) ? 1 : 0;
      grid.unknown[cell] = !is_seen && map_->cells[cell] < 0 ? 1 : 0;
    }
  grid.clearance_m = distances_m(grid.frame, occupied);
  return grid;
}

std::optional<Vector2d> Planner::blocked_at(const PlanGrid& grid, const Vector2d& p_W) const {
  // A cell less than planned is the error of cells; near the vehicle it is too late, and it may leave.
  const double cell_m = grid.frame.cell_m, keep_m = std::max(params_.costs.keep_m - cell_m, 0.5 * cell_m);
  const OnPath here = nearest_on(path_W_, p_W);
  for (double ahead_m = 0;; ahead_m += cell_m) {
    const Vector2d at_W = ahead_on(path_W_, here, ahead_m);
    if (grid.clearance_at(at_W) < keep_m && (at_W - p_W).norm() > params_.costs.keep_m) return at_W;
    if (at_W == path_W_.back()) break;
  }
  return std::nullopt;
}

Planner::Decision Planner::step(std::int64_t utime) {
  if (!map_ || !estimate_) return {};
  const double variance_m2 = estimate_->covariance_m2[0] + estimate_->covariance_m2[4];
  const Pose2 pose{{estimate_->position_m[0], estimate_->position_m[1]}, estimate_->yaw_rad};
  if (!(variance_m2 < 2 * squared(params_.lost_std_m)) || !pose.p_W.allFinite()) {
    // What was seen shortly before is doubtful, too: the vehicle may have been lost already and have put it at wrong
    // places.
    if (!seen_before_.empty()) seen_ = seen_before_.front();
    seen_before_.clear();
    scans_.clear();
    is_due_ = true;
    return {};
  }
  see(pose);
  if (current_ >= goals_W_.size()) return path_W_.empty() ? Decision{} : stop(utime, {}, {});
  const Vector2d& goal_W = goals_W_[current_];
  if ((goal_W - pose.p_W).norm() < params_.reached_m) {
    ++reached_;
    return next_goal(utime, fmt::format("reached {}", text_of(goal_W)));
  }
  if (no_path_since_ && seconds(utime - *no_path_since_) > params_.give_up_s) {
    ++given_up_;
    return next_goal(utime, fmt::format("gives {} up", text_of(goal_W)));
  }
  const PlanGrid now = grid();
  if (no_path_since_) {
    if (!is_due_ && seconds(utime - tried_utime_) < params_.retry_s) return {};
    return plan(utime, pose.p_W, now, {});
  }
  if (is_due_) return plan(utime, pose.p_W, now, {});
  if ((nearest_on(path_W_, pose.p_W).p_W - pose.p_W).norm() > params_.stray_m) return plan(utime, pose.p_W, now, {});
  if (const auto at_W = blocked_at(now, pose.p_W))
    return plan(utime, pose.p_W, now, fmt::format("the path is blocked at {}", text_of(*at_W)));
  return {};
}

Planner::Decision Planner::plan(std::int64_t utime, const Vector2d& p_W, const PlanGrid& grid, std::string line) {
  const Path path = search_path(grid, p_W, goals_W_[current_], params_.costs);
  ++plans_;
  is_due_ = false;
  tried_utime_ = utime;
  if (path.points_W.empty()) {
    // The same failure is reported once, not at every retry.
    if (no_path_since_ && path.why_none == why_none_) return {};
    if (!no_path_since_) no_path_since_ = utime;
    why_none_ = path.why_none;
    return stop(utime, {p_W},
                fmt::format("no path from {} to {}: {}", text_of(p_W), text_of(goals_W_[current_]), why_none_));
  }
  no_path_since_.reset();
  path_W_ = path.points_W;
  if (!line.empty()) line += ": another path";
  return {path_message(utime, path_W_), std::move(line)};
}

Planner::Decision Planner::next_goal(std::int64_t utime, std::string line) {
  current_ = loop_ && current_ > 0 && current_ + 1 == goals_W_.size() ? 0 : current_ + 1;
  is_due_ = true;
  no_path_since_.reset();
  return stop(utime, {}, std::move(line));
}

Planner::Decision Planner::stop(std::int64_t utime, const std::vector<Vector2d>& at_W, std::string line) {
  path_W_.clear();
  return {path_message(utime, at_W), std::move(line)};
}

}  // namespace autonomy
