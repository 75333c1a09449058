// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/place_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "autonomy/mapping/pose_graph.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

namespace {

constexpr double near_something = 0.2;

/// The largest field in each square of `side` cells.
struct CoarseField {
  CoarseField(const OccupancyMap& map, int square)
      : side(square), columns((map.columns() + side - 1) / side), rows((map.rows() + side - 1) / side) {
    values.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int row = 0; row < map.rows(); ++row)
      for (int column = 0; column < map.columns(); ++column) {
        std::uint8_t& value = values[index(column / side, row / side)];
        value = std::max(value, map.field_at(column, row));
      }
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  /// Value of the square with this cell; 0 outside of the map.
  int at(int column, int row) const {
    const int c = column / side, r = row / side;
    if (column < 0 || row < 0 || c >= columns || r >= rows) return 0;
    return values[index(c, r)];
  }

  int side, columns, rows;
  std::vector<std::uint8_t> values;
};

bool is_blocked(const OccupancyMap& map, const Vector2d& from_W, const Vector2d& end_W) {
  constexpr double step_m = 0.04, before_end_m = 0.3;
  const Vector2d ray_W = end_W - from_W;
  const double length_m = ray_W.norm();
  for (double at_m = 0; at_m < length_m - before_end_m; at_m += step_m) {
    const Vector2d at_W = from_W + at_m / length_m * ray_W;
    if (map.is_occupied(map.column_of(at_W.x()), map.row_of(at_W.y()))) return true;
  }
  return false;
}

/// Information of a candidate.
Eigen::Matrix3d loose() {
  return loose_covariance().inverse();
}

}  // namespace

Eigen::Matrix3d loose_covariance() {
  constexpr double std_m = 0.1, std_rad = 0.05;
  return Eigen::Vector3d(squared(std_m), squared(std_m), squared(std_rad)).asDiagonal();
}

Fit fit_of(const OccupancyMap& map, const Beams& beams, const Pose2& pose, double enough_near) {
  const Vector2d from_W = pose.p_W + turned(beams.sensor_B, pose.yaw_rad);
  const auto all = static_cast<double>(std::max<std::size_t>(1, beams.points_B.size()));
  int near = 0, contradicting = 0, through = 0;
  for (const Vector2d& point_B : beams.points_B) {
    const Vector2d end_W = pose.p_W + turned(point_B, pose.yaw_rad);
    if (is_blocked(map, from_W, end_W)) {
      ++contradicting;
      if (map.field(end_W) > near_something) ++through;
    } else if (map.field(end_W) > near_something)
      ++near;
    else if (map.is_known(end_W))
      ++contradicting;
    // Enough beams fit: the rest cannot change the decision.
    if (near >= enough_near * all) break;
  }
  return {near / all, contradicting / all, through / all};
}

void PlaceSearch::move(const Increment& by) {
  for (Candidate& each : candidates_) each.pose = composed(each.pose, {{by.forward_m, by.left_m}, by.turn_rad});
  since_view_.forward_m += std::hypot(by.forward_m, by.left_m);
  since_view_.turn_rad += std::abs(by.turn_rad);
}

void PlaceSearch::sort(std::size_t max) {
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.evidence > b.evidence; });
  constexpr double same_m = 0.3, same_rad = 0.2;
  std::vector<Candidate> kept;
  for (const Candidate& each : candidates_) {
    if (kept.size() == max) break;
    // Matches from neighboring starting points end in one place, which is one candidate.
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return (other.pose.p_W - each.pose.p_W).norm() < same_m &&
             std::abs(sim::wrap_angle(other.pose.yaw_rad - each.pose.yaw_rad)) < same_rad;
    });
    if (is_new) kept.push_back(each);
  }
  candidates_ = std::move(kept);
}

void PlaceSearch::begin(const OccupancyMap& map, const ScanMatcher& matcher, const Beams& beams,
                        const Pose2& expected) {
  const double cell_m = map.params().cell_m;
  const int side = std::max(1, static_cast<int>(std::lround(params_.step_m / cell_m)));
  const CoarseField field(map, side);
  const int headings = static_cast<int>(std::lround(2 * std::numbers::pi / params_.step_rad));
  constexpr std::size_t every = 3, tried = 8;
  candidates_.clear();
  for (int heading = 0; heading < headings; ++heading) {
    const double yaw_rad = sim::wrap_angle(2 * std::numbers::pi * heading / headings);
    std::vector<std::pair<int, int>> offsets;
    for (std::size_t i = 0; i < beams.points_B.size(); i += every) {
      const Vector2d arm = turned(beams.points_B[i], yaw_rad) / cell_m;
      offsets.emplace_back(static_cast<int>(std::lround(arm.x())), static_cast<int>(std::lround(arm.y())));
    }
    for (int row = side / 2; row < map.rows(); row += side)
      for (int column = side / 2; column < map.columns(); column += side) {
        // A vehicle stands where nothing is.
        const Vector2d p_W = map.params().low_W + cell_m * Vector2d(column + 0.5, row + 0.5);
        if (!map.is_known(p_W) || map.field(p_W) > near_something) continue;
        int sum = 0;
        for (const auto& [right, up] : offsets) sum += field.at(column + right, row + up);
        candidates_.push_back({{p_W, yaw_rad}, static_cast<double>(sum)});
      }
  }
  const std::size_t max = std::min(candidates_.size(), tried * params_.candidates);
  std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(max), candidates_.end(),
                    [](const Candidate& a, const Candidate& b) {
                      const auto key = [](const Candidate& each) {
                        return std::tuple(-each.evidence, each.pose.yaw_rad, each.pose.p_W.x(), each.pose.p_W.y());
                      };
                      return key(a) < key(b);
                    });
  candidates_.resize(max);
  candidates_.push_back({expected, 0});
  for (Candidate& each : candidates_) {
    each.pose = matcher.match(map, beams.points_B, each.pose, loose()).pose;
    each.evidence = fit_of(map, beams, each.pose).evidence();
  }
  candidates_.back().evidence += params_.expected_lead;
  sort(params_.candidates);
}

std::optional<Pose2> PlaceSearch::look(const OccupancyMap& map, const ScanMatcher& matcher, const Beams& beams,
                                       const Pose2& expected) {
  if (beams.points_B.size() < min_judged_points) return std::nullopt;
  if (candidates_.empty() || views_ >= params_.max_views) {
    begin(map, matcher, beams, expected);
    views_ = 1;
    since_view_ = {};
    return std::nullopt;
  }
  // Scans from one place share their errors, so they count as one view.
  const bool moved = since_view_.forward_m > params_.apart_m || since_view_.turn_rad > params_.apart_rad;
  for (Candidate& each : candidates_) {
    each.pose = matcher.match(map, beams.points_B, each.pose, loose()).pose;
    if (moved) each.evidence += fit_of(map, beams, each.pose).evidence();
  }
  if (!moved) return std::nullopt;
  since_view_ = {};
  ++views_;
  sort(params_.candidates);
  if (views_ < params_.min_views || candidates_.front().evidence < params_.min_mean * views_) return std::nullopt;
  // The runner-up must be clearly worse: rooms that look alike can only be distinguished by moving on.
  if (candidates_.size() > 1 && candidates_[0].evidence < candidates_[1].evidence + params_.lead) return std::nullopt;
  return candidates_.front().pose;
}

}  // namespace autonomy
