// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace autonomy {

namespace {

/// A cell is decayed and its time of observation counted when it was last updated at least this long before.
constexpr float update_s = 10;
/// Time between two updates from which on the cell was not under observation.
constexpr float watch_s = 3600;
/// Reach of the likelihood field, in cells.
constexpr int reach = 3;

}  // namespace

OccupancyMap::OccupancyMap(const Params& params) : params_(params) {
  const Vector2d size_m = params.high_W - params.low_W;
  if (!(size_m.minCoeff() > 0))
    throw std::invalid_argument("the area of the map must go from smaller to larger x and y");
  const double columns = std::ceil(size_m.x() / params.cell_m - 1e-6),
               rows = std::ceil(size_m.y() / params.cell_m - 1e-6);
  if (columns * rows > 16e6) throw std::invalid_argument("the map must have at most 16 million cells");
  columns_ = static_cast<int>(columns);
  rows_ = static_cast<int>(rows);
  tile_columns_ = (columns_ + tile_cells - 1) / tile_cells;
  tiles_.resize(static_cast<std::size_t>(tile_columns_) *
                static_cast<std::size_t>((rows_ + tile_cells - 1) / tile_cells));
  // A map that forgets stores 2p - 1 = tanh(log odds / 2), which decays towards 0, unknown.
  const auto unit = [&](double log_odds) {
    return static_cast<float>(params.forgets ? std::tanh(0.5 * log_odds) : log_odds);
  };
  hit_ = unit(params.hit);
  miss_ = unit(params.miss);
  limit_ = unit(params.max_log_odds);
  becomes_occupied_ = unit(0.6);
  becomes_free_ = unit(-0.2);
  // Likelihood field (Thrun, Burgard and Fox 2005, 6.4): a Gaussian of the distance to the nearest occupied cell, in
  // steps of 1/255.
  kernel_.resize(reach + 1);
  for (int i = 0; i <= reach; ++i)
    for (int k = 0; k <= reach; ++k) {
      const double distance_m = std::hypot(i, k) * params.cell_m;
      kernel_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>(std::lround(255 * std::exp(-0.5 * squared(distance_m / params.field_std_m))));
    }
}

OccupancyMap::Tile& OccupancyMap::own_tile(int column, int row) {
  std::shared_ptr<Tile>& tile =
      tiles_[static_cast<std::size_t>(row / tile_cells * tile_columns_ + column / tile_cells)];
  if (!tile)
    tile = std::make_shared<Tile>();
  else if (tile.use_count() > 1)
    tile = std::make_shared<Tile>(*tile);
  return *tile;
}

float OccupancyMap::forgotten(const CellState& cell, float now_s) const {
  const float dt_s = now_s - cell.seen_s;
  if (!params_.forgets || dt_s <= 0) return cell.belief;
  const auto dwell_s = static_cast<float>(params_.dwell_s) + cell.observed_s;
  const float mean_s =
      std::max(static_cast<float>(params_.min_dwell_s), dwell_s / static_cast<float>(1 + cell.changes));
  return cell.belief * std::exp(-2 * dt_s / mean_s);
}

bool OccupancyMap::observe(CellState& cell, float evidence, float now_s) const {
  // Forget since the last time.
  if (cell.seen_s < 0) {
    cell.seen_s = now_s;
  } else if (const float dt_s = now_s - cell.seen_s; dt_s >= update_s) {
    cell.belief = forgotten(cell, now_s);
    cell.observed_s += std::min(dt_s, watch_s);
    cell.seen_s = now_s;
  }
  // Bayes' rule for independent observations: log-odds add up, which for b = 2 p - 1 = tanh(L / 2) is the sum of tanh.
  const float sum = cell.belief + evidence;
  cell.belief = params_.forgets ? std::clamp(sum / (1 + cell.belief * evidence), -limit_, limit_) : sum;
  // Hysteresis: noise at the border of two cells is not a change.
  const bool occupied = cell.belief > (cell.occupied ? becomes_free_ : becomes_occupied_);
  if (occupied == cell.occupied) return false;
  if (cell.observed_s > 0 && cell.changes < 65535) ++cell.changes;
  cell.occupied = occupied;
  return true;
}

/// Calls `visit(column, row)` for the cells of a line to `less_m` before its end (Amanatides and Woo 1987).
template <class Visit>
void OccupancyMap::visit_passed(const Vector2d& sensor_W, const Vector2d& end_W, double less_m, Visit visit) const {
  const Vector2d ray = end_W - sensor_W;
  const double length = (ray.norm() - less_m) / params_.cell_m;
  if (!(length > 0)) return;
  // In units of cells.
  const Vector2d direction = ray.normalized(), from = (sensor_W - params_.low_W) / params_.cell_m;
  int at[2] = {column_of(sensor_W.x()), row_of(sensor_W.y())}, step[2];
  double next[2], each[2];
  for (int axis = 0; axis < 2; ++axis) {
    constexpr double never = 1e30;
    step[axis] = direction[axis] > 0 ? 1 : -1;
    const double border = direction[axis] > 0 ? at[axis] + 1 : at[axis];
    each[axis] = direction[axis] != 0 ? 1 / std::abs(direction[axis]) : never;
    next[axis] = direction[axis] != 0 ? (border - from[axis]) / direction[axis] : never;
  }
  for (double traveled = 0; traveled < length;) {
    if (at[0] < 0 || at[1] < 0 || at[0] >= columns_ || at[1] >= rows_) return;
    visit(at[0], at[1]);
    const int axis = next[0] < next[1] ? 0 : 1;
    traveled = next[axis];
    next[axis] += each[axis];
    at[axis] += step[axis];
  }
}

void OccupancyMap::insert(const Vector2d& sensor_W, const std::vector<Vector2d>& ends_W, const std::vector<char>& hits,
                          double now_s) {
  // The tile of the last cell, because beams stay in a tile for a while.
  int tile_column = -1, tile_row = -1;
  Tile* tile = nullptr;
  const auto cell_at = [&](int column, int row) -> CellState& {
    if (column / tile_cells != tile_column || row / tile_cells != tile_row) {
      tile_column = column / tile_cells;
      tile_row = row / tile_cells;
      tile = &own_tile(column, row);
    }
    return tile->cells[cell_of(column, row)];
  };
  changed_.clear();
  ends_.clear();
  // A cell in which a beam ends is not passed by its neighbors, which graze the surface.  A beam that ends beside an
  // occupied cell has met the same surface, first one that is kept: otherwise surfaces would become thick, and move
  // with the errors of poses.
  const auto add_end = [&](const Vector2d& end_W) {
    int column = column_of(end_W.x()), row = row_of(end_W.y());
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
    if (!is_anchor(column, row) && !use_neighbor(column, row, &OccupancyMap::is_anchor) && !is_occupied(column, row))
      use_neighbor(column, row, &OccupancyMap::is_occupied);
    CellState& cell = cell_at(column, row);
    if (cell.is_end) return;
    cell.is_end = true;
    ends_.push_back({column, row});
  };
  for (std::size_t i = 0; i < ends_W.size(); ++i) {
    if (hits[i] == 0) continue;
    add_end(ends_W[i]);
    // The surface between two beams that end near each other.
    if (i == 0 || hits[i - 1] == 0) continue;
    const Vector2d gap = ends_W[i] - ends_W[i - 1];
    const double gap_m = gap.norm();
    if (gap_m > params_.surface_m) continue;
    for (double at_m = params_.cell_m; at_m < gap_m; at_m += params_.cell_m)
      add_end(ends_W[i - 1] + at_m / gap_m * gap);
  }
  const auto time_s = static_cast<float>(now_s);
  const auto take = [&](CellState& cell, int column, int row, float evidence) {
    if (observe(cell, evidence, time_s)) changed_.push_back({column, row});
  };
  for (std::size_t i = 0; i < ends_W.size(); ++i)
    visit_passed(sensor_W, ends_W[i], hits[i] != 0 ? params_.cell_m : 0, [&](int column, int row) {
      CellState& cell = cell_at(column, row);
      if (!cell.is_end) take(cell, column, row, -miss_);
    });
  for (const auto& [column, row] : ends_) {
    CellState& cell = cell_at(column, row);
    cell.is_end = false;
    take(cell, column, row, hit_);
  }
  update_field();
}

bool OccupancyMap::is_occupied(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return false;
  const Tile* tile = tile_of(column, row).get();
  return tile != nullptr && tile->cells[cell_of(column, row)].occupied;
}

bool OccupancyMap::is_anchor(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return false;
  const Tile* tile = tile_of(column, row).get();
  return tile != nullptr && tile->anchor[cell_of(column, row)] == 255;
}

bool OccupancyMap::use_neighbor(int& column, int& row, bool (OccupancyMap::*is_surface)(int, int) const) const {
  // Those beside it, then those across its corners.
  static constexpr int neighbors[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  for (const auto& [right, up] : neighbors) {
    if (!(this->*is_surface)(column + right, row + up)) continue;
    column += right;
    row += up;
    return true;
  }
  return false;
}

void OccupancyMap::anchor() {
  for (std::shared_ptr<Tile>& tile : tiles_) {
    if (!tile) continue;
    tile = std::make_shared<Tile>(*tile);
    tile->anchor = tile->field;
  }
  anchored_shift_ = 3;
}

void OccupancyMap::update_field() {
  for (const auto& [column, row] : changed_) {
    const bool occupied = is_occupied(column, row);
    for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); ++r)
      for (int c = std::max(0, column - reach); c <= std::min(columns_ - 1, column + reach); ++c) {
        std::uint8_t& value = own_tile(c, r).field[cell_of(c, r)];
        const auto kernel = [&](int dc, int dr) {
          return kernel_[static_cast<std::size_t>(std::abs(dr))][static_cast<std::size_t>(std::abs(dc))];
        };
        if (occupied) {
          value = std::max(value, kernel(c - column, r - row));
          continue;
        }
        // A cell that became free may have been the nearest one of its neighbors, which now look for the next.
        value = 0;
        for (int dr = -reach; dr <= reach; ++dr)
          for (int dc = -reach; dc <= reach; ++dc)
            if (is_occupied(c + dc, r + dr)) value = std::max(value, kernel(dc, dr));
      }
  }
}

int OccupancyMap::percent(int column, int row, double now_s) const {
  const Tile* tile = tile_of(column, row).get();
  if (tile == nullptr) return unknown_percent;
  const CellState& cell = tile->cells[cell_of(column, row)];
  if (cell.seen_s < 0) return unknown_percent;
  const double belief = static_cast<double>(forgotten(cell, static_cast<float>(now_s)));
  return static_cast<int>(std::lround(params_.forgets ? 50 + 50 * belief : 100 / (1 + std::exp(-belief))));
}

double OccupancyMap::field(const Vector2d& p_W) const {
  const double x = (p_W.x() - params_.low_W.x()) / params_.cell_m - 0.5;
  const double y = (p_W.y() - params_.low_W.y()) / params_.cell_m - 0.5;
  const double column = std::floor(x), row = std::floor(y);
  if (!(std::abs(column) < 1e8 && std::abs(row) < 1e8)) return 0;
  const double right = x - column, up = y - row;
  const int c = static_cast<int>(column), r = static_cast<int>(row);
  if (c >= 0 && r >= 0 && c + 1 < columns_ && r + 1 < rows_ && c % tile_cells + 1 < tile_cells &&
      r % tile_cells + 1 < tile_cells) {
    // Usually all four are in one tile.
    const Tile* tile = tile_of(c, r).get();
    if (tile == nullptr) return 0;
    const std::size_t cell = cell_of(c, r);
    return ((1 - up) * ((1 - right) * field_of(*tile, cell) + right * field_of(*tile, cell + 1)) +
            up * ((1 - right) * field_of(*tile, cell + tile_cells) + right * field_of(*tile, cell + tile_cells + 1))) /
           255;
  }
  return ((1 - up) * ((1 - right) * field_at(c, r) + right * field_at(c + 1, r)) +
          up * ((1 - right) * field_at(c, r + 1) + right * field_at(c + 1, r + 1))) /
         255;
}

bool OccupancyMap::is_known(const Vector2d& p_W) const {
  const int column = column_of(p_W.x()), row = row_of(p_W.y());
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return false;
  const Tile* tile = tile_of(column, row).get();
  return tile != nullptr && tile->cells[cell_of(column, row)].seen_s >= 0;
}

}  // namespace autonomy
