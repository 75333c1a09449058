// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/mapping/scan_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

/// Ends of beams as offsets in cells from the pose, for one heading.
struct Offsets {
  std::vector<int> columns, rows;
  void set(const std::vector<Vector2d>& points_B, double yaw_rad, double x_m, double y_m, double cell_m) {
    columns.resize(points_B.size());
    rows.resize(points_B.size());
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    for (std::size_t i = 0; i < points_B.size(); ++i) {
      columns[i] = static_cast<int>(std::floor((x_m + c * points_B[i].x() - s * points_B[i].y()) / cell_m));
      rows[i] = static_cast<int>(std::floor((y_m + s * points_B[i].x() + c * points_B[i].y()) / cell_m));
    }
  }
};

/// Part of a map's field, as one block of memory.
class FieldPatch {
 public:
  FieldPatch(const OccupancyMap& map, int first_column, int first_row, int columns, int rows)
      : first_column_(first_column),
        first_row_(first_row),
        columns_(columns),
        rows_(rows),
        side_(1),
        field_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        field_[index(column, row)] = map.field_at(first_column + column, first_row + row);
  }
  /// Maxima over squares of twice the side, to the right and up, of those of a patch over `side` cells.
  FieldPatch(const FieldPatch& finer, int side)
      : first_column_(finer.first_column_),
        first_row_(finer.first_row_),
        columns_(finer.columns_),
        rows_(finer.rows_),
        side_(2 * side),
        field_(finer.field_.size()) {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) {
        const int right = std::min(column + side, columns_ - 1), up = std::min(row + side, rows_ - 1);
        field_[index(column, row)] = std::max({finer.field_[index(column, row)], finer.field_[index(right, row)],
                                               finer.field_[index(column, up)], finer.field_[index(right, up)]});
      }
  }
  int sum(const Offsets& offsets, int column, int row) const {
    int sum = 0;
    for (std::size_t i = 0; i < offsets.columns.size(); ++i) {
      const int c = offsets.columns[i] + column - first_column_, r = offsets.rows[i] + row - first_row_;
      // A square that begins before the patch may end in it.
      if (c > -side_ && r > -side_ && c < columns_ && r < rows_) sum += field_[index(std::max(c, 0), std::max(r, 0))];
    }
    return sum;
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  int first_column_, first_row_, columns_, rows_, side_;
  std::vector<std::uint8_t> field_;
};

double score_from(int sum, std::size_t points) {
  return sum / (255.0 * static_cast<double>(points));
}

/// Improves a pose by trying its neighbours in steps that are halved.  `loss(pose)` is taken from the score.
template <class Loss>
ScanMatch refine(const OccupancyMap& map, const std::vector<Vector2d>& points_B, ScanMatch best, double step_m,
                 double step_rad, int halvings, Loss loss) {
  best.score = score_of(map, points_B, best.pose) - loss(best.pose);
  for (int level = 0; level < halvings; ++level, step_m /= 2, step_rad /= 2) {
    const Pose2 centre = best.pose;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int turn = -1; turn <= 1; ++turn) {
          const Pose2 pose{centre.p_W + step_m * Vector2d(x, y), centre.yaw_rad + turn * step_rad};
          const double score = score_of(map, points_B, pose) - loss(pose);
          if (score > best.score) best = {pose, score};
        }
  }
  return best;
}

/// Returns the share of beams that pass through something in the map before they end.
double blocked_share(const OccupancyMap& map, const std::vector<Sight>& sights, const Pose2& pose) {
  constexpr double step_m = 0.1, before_end_m = 0.3, something = 0.6;
  int blocked = 0;
  for (const Sight& sight : sights) {
    const Vector2d from_W = pose.p_W + turned(sight.from_B, pose.yaw_rad);
    const Vector2d ray_W = turned(sight.end_B - sight.from_B, pose.yaw_rad);
    const double length_m = ray_W.norm();
    for (double at_m = 0; at_m < length_m - before_end_m; at_m += step_m) {
      if (map.field(from_W + at_m / length_m * ray_W) < something) continue;
      ++blocked;
      break;
    }
  }
  return static_cast<double>(blocked) / static_cast<double>(sights.size());
}

}  // namespace

double score_of(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  double sum = 0;
  for (const Vector2d& p : points_B)
    sum += map.field(pose.p_W + Vector2d(c * p.x() - s * p.y(), s * p.x() + c * p.y()));
  return points_B.empty() ? 0 : sum / static_cast<double>(points_B.size());
}

ScanMatch ScanMatcher::match(const OccupancyMap& map, const std::vector<Vector2d>& points_B,
                             const Pose2& predicted) const {
  if (points_B.empty()) return {predicted, 0};
  const double cell_m = map.params().cell_m;
  const auto loss = [&](const Pose2& pose) {
    return params_.prior_weight * ((pose.p_W - predicted.p_W).squaredNorm() / squared(params_.prior_std_m) +
                                   squared((pose.yaw_rad - predicted.yaw_rad) / params_.prior_std_rad));
  };
  // All poses of the window; half of the points suffice.
  std::vector<Vector2d> some;
  for (std::size_t i = 0; i < points_B.size(); i += 2) some.push_back(points_B[i]);
  const int cells = static_cast<int>(std::ceil(params_.window_m / cell_m));
  const int turns = static_cast<int>(std::ceil(params_.window_rad / params_.step_rad));
  const double x_m = predicted.p_W.x() - map.params().low_W.x(), y_m = predicted.p_W.y() - map.params().low_W.y();
  Offsets offsets;
  ScanMatch best{predicted, -1};
  for (int turn = -turns; turn <= turns; ++turn) {
    const double yaw_rad = predicted.yaw_rad + turn * params_.step_rad;
    offsets.set(some, yaw_rad, x_m, y_m, cell_m);
    for (int row = -cells; row <= cells; ++row)
      for (int column = -cells; column <= cells; ++column) {
        int sum = 0;
        for (std::size_t i = 0; i < some.size(); ++i)
          sum += map.field_at(offsets.columns[i] + column, offsets.rows[i] + row);
        const Pose2 pose{predicted.p_W + cell_m * Vector2d(column, row), yaw_rad};
        const double score = score_from(sum, some.size()) - loss(pose);
        if (score > best.score) best = {pose, score};
      }
  }
  constexpr int halvings = 5;
  best = refine(map, points_B, best, cell_m / 2, params_.step_rad / 2, halvings, loss);
  best.score += loss(best.pose);
  return best;
}

std::optional<GlobalMatch> search_map(const OccupancyMap& map, const std::vector<Sight>& sights, double min_score) {
  if (sights.empty()) return std::nullopt;
  std::vector<Vector2d> points_B;
  for (const Sight& sight : sights) points_B.push_back(sight.end_B);
  // Maxima over squares of 2, 4, ... cells.  The finest ones also allow for the steps of the heading.
  constexpr int finest = 1, coarsest = 5;
  // Scans that fit nowhere are like many places: the search is given up then.
  constexpr int max_visited = 600'000, max_taken = 4000;
  std::vector<FieldPatch> levels;
  levels.emplace_back(map, 0, 0, map.columns(), map.rows());
  for (int level = 0; level < coarsest; ++level) levels.emplace_back(levels.back(), 1 << level);
  const double cell_m = map.params().cell_m;
  double reach_m = 1;
  for (const Vector2d& point : points_B) reach_m = std::max(reach_m, point.norm());
  const int headings = static_cast<int>(std::ceil(2 * std::numbers::pi * reach_m / (2 * cell_m)));
  struct Candidate {
    int heading, column, row;
    double score;
  };
  // Squares of the coarsest level.
  std::vector<Offsets> offsets(static_cast<std::size_t>(headings));
  std::vector<Candidate> squares;
  for (int heading = 0; heading < headings; ++heading) {
    Offsets& each = offsets[static_cast<std::size_t>(heading)];
    each.set(points_B, 2 * std::numbers::pi * heading / headings, 0, 0, cell_m);
    for (int row = 0; row < map.rows(); row += 1 << coarsest)
      for (int column = 0; column < map.columns(); column += 1 << coarsest) {
        const double score = score_from(levels[coarsest].sum(each, column, row), points_B.size());
        if (score > min_score) squares.push_back({heading, column, row, score});
      }
  }
  // Divide squares; what cannot be among the best is left.
  GlobalMatch found;
  found.best.score = min_score;
  const auto pose_of = [&](const Candidate& square) {
    const double half = 0.5 * (1 << finest);
    return Pose2{map.params().low_W + cell_m * Vector2d(square.column + half, square.row + half),
                 sim::wrap_angle(2 * std::numbers::pi * square.heading / headings)};
  };
  const auto is_other = [](const Pose2& a, const Pose2& b) {
    return (a.p_W - b.p_W).norm() > 1 || std::abs(sim::wrap_angle(a.yaw_rad - b.yaw_rad)) > 0.5;
  };
  bool any = false;
  // Squares near a pose that was refined lead to the same pose.
  std::vector<Pose2> judged;
  const auto is_judged = [&](const Pose2& pose) {
    return std::any_of(judged.begin(), judged.end(), [&](const Pose2& each) {
      return (each.p_W - pose.p_W).norm() < 0.08 && std::abs(sim::wrap_angle(each.yaw_rad - pose.yaw_rad)) < 0.02;
    });
  };
  const auto take = [&](const Candidate& leaf) {
    const Pose2 pose = pose_of(leaf);
    ScanMatch match =
        refine(map, points_B, {pose, 0}, cell_m, std::numbers::pi / headings, 5, [](const Pose2&) { return 0.0; });
    judged.push_back(match.pose);
    if (match.score <= std::max(min_score, found.other_score)) return;
    match.score -= blocked_share(map, sights, match.pose);
    if (match.score > found.best.score) {
      if (any && is_other(match.pose, found.best.pose)) found.other_score = found.best.score;
      found.best = match;
      any = true;
    } else if (any && is_other(match.pose, found.best.pose)) {
      found.other_score = std::max(found.other_score, match.score);
    }
  };
  // The best square of any size next: its bound is that of all that remain.
  const auto worse = [](const std::pair<int, Candidate>& a, const std::pair<int, Candidate>& b) {
    const auto key = [](const std::pair<int, Candidate>& each) {
      const Candidate& c = each.second;
      return std::tuple(c.score, -each.first, c.heading, c.row, c.column);
    };
    return key(a) < key(b);
  };
  std::vector<std::pair<int, Candidate>> open;
  for (const Candidate& square : squares) open.emplace_back(coarsest, square);
  std::make_heap(open.begin(), open.end(), worse);
  for (int visited = 0, taken = 0; !open.empty() && visited < max_visited && taken < max_taken; ++visited) {
    std::pop_heap(open.begin(), open.end(), worse);
    const auto [level, candidate] = open.back();
    open.pop_back();
    if (candidate.score <= std::max(min_score, found.other_score)) break;
    const bool near_best = any && !is_other(pose_of(candidate), found.best.pose);
    if (near_best && candidate.score <= found.best.score) continue;
    if (level == finest) {
      if (is_judged(pose_of(candidate))) continue;
      take(candidate);
      ++taken;
      continue;
    }
    const int half = 1 << (level - 1);
    const Offsets& each = offsets[static_cast<std::size_t>(candidate.heading)];
    for (const int up : {0, half})
      for (const int right : {0, half}) {
        Candidate quarter{candidate.heading, candidate.column + right, candidate.row + up, 0};
        quarter.score = score_from(levels[static_cast<std::size_t>(level - 1)].sum(each, quarter.column, quarter.row),
                                   points_B.size());
        open.emplace_back(level - 1, quarter);
        std::push_heap(open.begin(), open.end(), worse);
      }
  }
  return any ? std::optional(found) : std::nullopt;
}

}  // namespace autonomy
