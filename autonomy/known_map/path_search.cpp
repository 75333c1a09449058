// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/path_search.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <queue>

namespace autonomy {

namespace {

constexpr double impassable = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const PlanGrid& grid, const Vector2d& from_W, const PathCosts& costs)
      : grid_(grid), costs_(costs), from_W_(from_W), from_clearance_m_(grid.clearance_at(from_W)) {}

  /// Cost of a meter at a cell; infinite: impassable.
  double cost_at(int column, int row) const {
    if (!grid_.frame.contains(column, row)) return impassable;
    const std::size_t cell = grid_.frame.index(column, row);
    const double clearance_m = static_cast<double>(grid_.clearance_m[cell]);
    const bool unknown = grid_.unknown[cell] != 0;
    if (clearance_m < costs_.keep_m || (unknown && !costs_.enters_unknown)) {
      const double cell_m = grid_.frame.cell_m;
      const bool leaves = (grid_.frame.center_W(column, row) - from_W_).norm() < costs_.keep_m + 2 * cell_m &&
                          clearance_m > 0 && clearance_m >= std::min(from_clearance_m_, costs_.keep_m) - cell_m;
      if (!leaves) return impassable;
    }
    const double lacks = std::max(0.0, costs_.prefer_m - clearance_m) / std::max(1e-9, costs_.prefer_m - costs_.keep_m);
    return 1 + costs_.clearance_cost * squared(lacks) + (unknown ? costs_.unknown_cost : 0);
  }

  /// Cost of a step between the cells of two points; from a start that is impassable itself it may go anywhere.
  double cost_of_step(const Vector2d& from_W, const Vector2d& to_W) const {
    const auto at = [&](const Vector2d& p_W) {
      return cost_at(grid_.frame.column_of(p_W.x()), grid_.frame.row_of(p_W.y()));
    };
    const double here = at(from_W), there = at(to_W);
    return (here == impassable ? there : 0.5 * (here + there)) * (to_W - from_W).norm();
  }

  /// Returns whether the cells beside an oblique step are passable, between which it leads.
  bool is_open(int column, int row, int right, int up) const {
    if (right == 0 || up == 0) return true;
    const int x = right / std::abs(right), y = up / std::abs(up);
    const bool is_flat = std::abs(right) >= std::abs(up), is_steep = std::abs(up) >= std::abs(right);
    if (is_flat && cost_at(column + x, row) == impassable) return false;
    if (is_steep && cost_at(column, row + y) == impassable) return false;
    return is_flat == is_steep || cost_at(column + x, row + y) < impassable;
  }

  /// Cost of a straight line; infinite: something is in the path.
  double cost_of(const Vector2d& from_W, const Vector2d& to_W) const {
    const double length_m = (to_W - from_W).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length_m / grid_.frame.cell_m)));
    double sum = 0;
    for (int i = 0; i <= steps && sum < impassable; ++i) {
      const Vector2d at_W = from_W + static_cast<double>(i) / steps * (to_W - from_W);
      sum += (i == 0 || i == steps ? 0.5 : 1) * cost_at(grid_.frame.column_of(at_W.x()), grid_.frame.row_of(at_W.y()));
    }
    return sum * length_m / steps;
  }

  /// Returns the cells of the path from `start` to `goal`; none: there is impassable.
  std::vector<std::size_t> cells(std::size_t start, std::size_t goal) const;
  std::vector<Vector2d> straightened(const std::vector<Vector2d>& points_W) const;

 private:
  const PlanGrid& grid_;
  const PathCosts& costs_;
  Vector2d from_W_;
  double from_clearance_m_;
};

std::vector<std::size_t> Search::cells(std::size_t start, std::size_t goal) const {
  static constexpr int steps[16][2] = {{1, 0}, {1, 1}, {0, 1},  {-1, 1}, {-1, 0},  {-1, -1}, {0, -1}, {1, -1},
                                       {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-2, -1}, {-1, -2}, {1, -2}, {2, -1}};
  const GridFrame& frame = grid_.frame;
  const auto columns = static_cast<std::size_t>(frame.columns);
  const Vector2d goal_cell(static_cast<double>(goal % columns), static_cast<double>(goal / columns));
  std::vector<float> costs(frame.size(), std::numeric_limits<float>::infinity());
  std::vector<std::uint32_t> before(frame.size());
  std::vector<char> done(frame.size());
  // The cell breaks ties, so that the path does not depend on the queue.
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto add = [&](std::size_t cell, double cost, std::size_t from) {
    if (static_cast<float>(cost) >= costs[cell]) return;
    costs[cell] = static_cast<float>(cost);
    before[cell] = static_cast<std::uint32_t>(from);
    const Vector2d at(static_cast<double>(cell % columns), static_cast<double>(cell / columns));
    open.emplace(cost + frame.cell_m * (at - goal_cell).norm(), cell);
  };
  add(start, 0, start);
  while (!open.empty() && done[goal] == 0) {
    const std::size_t cell = open.top().second;
    open.pop();
    if (done[cell] != 0) continue;
    done[cell] = 1;
    const int column = static_cast<int>(cell % columns), row = static_cast<int>(cell / columns);
    const Vector2d here_W = frame.center_W(column, row);
    for (const auto& [right, up] : steps) {
      if (cost_at(column + right, row + up) == impassable || !is_open(column, row, right, up)) continue;
      const double cost = cost_of_step(here_W, frame.center_W(column + right, row + up));
      add(frame.index(column + right, row + up), static_cast<double>(costs[cell]) + cost, cell);
    }
  }
  std::vector<std::size_t> path;
  if (done[goal] == 0) return path;
  for (std::size_t cell = goal; cell != start; cell = before[cell]) path.push_back(cell);
  path.push_back(start);
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<Vector2d> Search::straightened(const std::vector<Vector2d>& points_W) const {
  constexpr double of_cells = 0.005;  // by which the cost of a line depends on where it crosses cells
  std::vector<Vector2d> kept{points_W.front()};
  for (std::size_t first = 0; first + 1 < points_W.size();) {
    std::size_t last = first + 1;
    double cost = cost_of_step(points_W[first], points_W[last]);
    for (std::size_t next = last + 1; next < points_W.size(); last = next++) {
      cost += cost_of_step(points_W[next - 1], points_W[next]);
      if (!(cost_of(points_W[first], points_W[next]) <= cost * (1 + of_cells))) break;
    }
    kept.push_back(points_W[last]);
    first = last;
  }
  return kept;
}

}  // namespace

double PlanGrid::clearance_at(const Vector2d& p_W) const {
  const int column = frame.column_of(p_W.x()), row = frame.row_of(p_W.y());
  return frame.contains(column, row) ? static_cast<double>(clearance_m[frame.index(column, row)]) : 0;
}

Path search_path(const PlanGrid& grid, const Vector2d& from_W, const Vector2d& to_W, const PathCosts& costs) {
  const GridFrame& frame = grid.frame;
  const auto cell_of = [&](const Vector2d& p_W) -> std::optional<std::size_t> {
    const int column = frame.column_of(p_W.x()), row = frame.row_of(p_W.y());
    if (!frame.contains(column, row)) return std::nullopt;
    return frame.index(column, row);
  };
  const auto start = cell_of(from_W), goal = cell_of(to_W);
  if (!start) return {{}, "it is outside of the map"};
  if (!goal) return {{}, "the goal is outside of the map"};
  const Search search(grid, from_W, costs);
  if (const double clearance_m = grid.clearance_at(to_W); clearance_m < costs.keep_m)
    return {{}, fmt::format("the goal is {:.2f} m from an obstacle, and must be {:.2f} m", clearance_m, costs.keep_m)};
  if (grid.unknown[*goal] != 0 && !costs.enters_unknown) return {{}, "the goal is in unknown space"};
  std::vector<Vector2d> points_W;
  for (const std::size_t cell : search.cells(*start, *goal)) {
    const auto columns = static_cast<std::size_t>(frame.columns);
    points_W.push_back(frame.center_W(static_cast<int>(cell % columns), static_cast<int>(cell / columns)));
  }
  if (points_W.empty())
    return {{},
            fmt::format("no gap on the path{} is {:.2f} m wide", costs.enters_unknown ? "" : " on known ground",
                        2 * costs.keep_m)};
  // Search moves between centers of cells; the path begins at the vehicle and ends at the goal itself.
  points_W.front() = from_W;
  if (points_W.size() == 1) points_W.push_back(to_W);
  points_W.back() = to_W;
  return {search.straightened(points_W), {}};
}

}  // namespace autonomy
