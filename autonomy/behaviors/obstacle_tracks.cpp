// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/obstacle_tracks.hpp"

#include <algorithm>
#include <cmath>

namespace autonomy {

std::vector<ObstacleTracks::Group> ObstacleTracks::groups_of(const Scan& scan, const Motion& own) const {
  std::vector<Group> groups;
  std::vector<Vector2d> points_W;
  bool connected = false;  // the group continues a longer one
  const auto close_group = [&](bool continues) {
    if (points_W.empty()) return;
    Group group;
    group.p_W = 0.5 * (points_W.front() + points_W.back());
    for (const Vector2d& point_W : points_W) group.radius_m = std::max(group.radius_m, (point_W - group.p_W).norm());
    group.alone = !connected && !continues;
    groups.push_back(group);
    points_W.clear();
    connected = continues;
  };
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i];
    if (!(range_m >= params_.range_min_m && range_m <= params_.range_m)) continue;
    const double angle_rad = own.yaw_rad + scan.first_angle_rad + static_cast<double>(i) * scan.step_rad;
    const Vector2d point_W = own.p_W + turned({range_m, 0}, angle_rad);
    if (!points_W.empty()) {
      if ((point_W - points_W.back()).norm() > params_.gap_m)
        close_group(false);
      else if ((point_W - points_W.front()).norm() > params_.extent_m)
        close_group(true);
    }
    points_W.push_back(point_W);
  }
  close_group(false);
  return groups;
}

Vector2d ObstacleTracks::velocity_of(const Track& track) const {
  const bool moves = track.alone && track.hits >= params_.hits && track.obstacle.v_W.norm() > params_.still_mps;
  return moves ? track.obstacle.v_W : Vector2d::Zero();
}

void ObstacleTracks::update(Track& track, const Group& group, std::int64_t utime) const {
  const double dt_s = seconds(utime - track.utime);
  track.utime = utime;
  ++track.hits;
  track.alone = group.alone;
  track.obstacle.radius_m = group.radius_m;
  // Part of a wall or of several things: its center jumps with what is seen of it, which would look like a motion.
  if (!group.alone) {
    track.obstacle.p_W = group.p_W;
    track.obstacle.v_W.setZero();
    return;
  }
  // Alpha-beta filter (Bar-Shalom, Li and Kirubarajan 2001, 6.5).
  const Vector2d predicted_W = track.obstacle.p_W + track.obstacle.v_W * dt_s;
  const Vector2d residual_W = group.p_W - predicted_W;
  track.obstacle.p_W = predicted_W + params_.alpha * residual_W;
  if (dt_s > 0) track.obstacle.v_W += params_.beta / dt_s * residual_W;
}

void ObstacleTracks::receive(const Scan& scan, const Motion& own) {
  if (!std::isfinite(own.yaw_rad) || !own.p_W.allFinite()) return;
  // A clock that was set back leaves tracks in the future.
  std::erase_if(tracks_,
                [&](const Track& track) { return std::abs(seconds(own.utime - track.utime)) > params_.memory_s; });
  std::vector<bool> matched(tracks_.size(), false);
  for (const Group& group : groups_of(scan, own)) {
    std::size_t best = matched.size();
    double nearest_m = params_.gate_m;
    for (std::size_t i = 0; i < matched.size(); ++i) {
      if (matched[i]) continue;
      const Track& track = tracks_[i];
      const double dt_s = seconds(own.utime - track.utime);
      const double distance_m = (track.obstacle.p_W + track.obstacle.v_W * dt_s - group.p_W).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      best = i;
    }
    if (best < matched.size()) {
      matched[best] = true;
      update(tracks_[best], group, own.utime);
    } else {
      tracks_.push_back({{group.p_W, Vector2d::Zero(), group.radius_m}, own.utime, 1, group.alone});
    }
  }
}

std::vector<Obstacle> ObstacleTracks::at(std::int64_t utime) const {
  std::vector<Obstacle> obstacles;
  for (const Track& track : tracks_) {
    const double age_s = seconds(utime - track.utime);
    if (std::abs(age_s) > params_.memory_s) continue;
    const Vector2d v_W = velocity_of(track);
    obstacles.push_back({track.obstacle.p_W + v_W * age_s, v_W, track.obstacle.radius_m});
  }
  return obstacles;
}

}  // namespace autonomy
