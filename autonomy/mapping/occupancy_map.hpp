// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Occupancy grid with a probability for each cell, and a likelihood field for matching scans.
///
/// With `forgets` a cell follows a two-state Markov chain (Meyer-Delius, Beinhofer and Burgard 2012, in continuous
/// time): occupied and free each last the dwell time T on average, and without observations for dt the probability p
/// goes towards 1/2: p - 1/2 decreases by exp(-2 dt / T).  Each cell learns T: the time that it has been observed, by
/// the number of changes that were seen; both begin as if one change had been seen in `dwell_s`.  Without `forgets`
/// log-odds add up forever, as in a world that does not change (Moravec and Elfes 1985).
///
/// A copy shares the tiles of the original until one of them changes: copies for rewinds are cheap.
class OccupancyMap {
 public:
  struct Params {
    Vector2d low_W{-25, -20}, high_W{25, 20};  ///< corners of the area
    double cell_m = 0.05;
    bool forgets = true;
    double dwell_s = 21600;     ///< expected dwell time of a cell in which no change was seen
    double min_dwell_s = 900;   ///< shortest dwell time
    double hit = 0.85;          ///< log-odds that a beam that ends in a cell adds
    double miss = 0.4;          ///< log-odds that a beam that passes a cell takes away
    double max_log_odds = 3.5;  ///< limit with `forgets`
    double surface_m = 0.5;     ///< neighboring beams that end nearer to each other have met one surface
    double field_std_m = 0.06;  ///< standard deviation of the likelihood field
  };
  static constexpr int unknown_percent = -1;

  /// Throws std::invalid_argument for an empty area and one of more than 16 million cells.
  explicit OccupancyMap(const Params& params);

  /// Takes a scan from `sensor_W`: `ends_W` are the ends of the beams; those with `hits[i]` met something.
  void insert(const Vector2d& sensor_W, const std::vector<Vector2d>& ends_W, const std::vector<char>& hits,
              double now_s);

  /// Returns the probability of occupancy at a time, 0 to 100; -1: never observed.
  int percent(int column, int row, double now_s) const;
  /// Returns the likelihood field at a point, 0 to 1: a Gaussian of the distance to the nearest occupied cell;
  /// interpolated between the centers of cells.
  double field(const Vector2d& p_W) const;
  /// The same at the nearest center, 0 to 255.
  std::uint8_t field_at(int column, int row) const {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return 0;
    const Tile* tile = tile_of(column, row).get();
    return tile == nullptr ? 0 : field_of(*tile, cell_of(column, row));
  }
  /// Keeps the present field: from now on it is the larger of it and of seven eighths of that of each time.  So a map
  /// whose parts come and go does not creep with the errors of poses.
  void anchor();
  bool is_occupied(int column, int row) const;
  /// Returns whether a beam has passed or met the cell at a point.
  bool is_known(const Vector2d& p_W) const;

  int column_of(double x_m) const { return static_cast<int>(std::floor((x_m - params_.low_W.x()) / params_.cell_m)); }
  int row_of(double y_m) const { return static_cast<int>(std::floor((y_m - params_.low_W.y()) / params_.cell_m)); }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Params& params() const { return params_; }

 private:
  static constexpr int tile_cells = 32;
  struct CellState {
    float belief = 0;      ///< 2 p - 1 with `forgets`, else log-odds
    float seen_s = -1;     ///< time of the last update; negative: never
    float observed_s = 0;  ///< how long it has been under observation
    std::uint16_t changes = 0;
    bool occupied = false;  ///< the state that counts for `changes` and the field
    bool is_end = false;    ///< a beam of the present scan ends in it
  };
  struct Tile {
    std::array<CellState, tile_cells * tile_cells> cells;
    std::array<std::uint8_t, tile_cells * tile_cells> field{}, anchor{};
  };

  static std::size_t cell_of(int column, int row) {
    return static_cast<std::size_t>(row % tile_cells * tile_cells + column % tile_cells);
  }
  std::uint8_t field_of(const Tile& tile, std::size_t cell) const {
    const std::uint8_t now = tile.field[cell], anchor = tile.anchor[cell];
    return std::max<std::uint8_t>(anchor, now - (now >> anchored_shift_));
  }
  const std::shared_ptr<Tile>& tile_of(int column, int row) const {
    return tiles_[static_cast<std::size_t>(row / tile_cells * tile_columns_ + column / tile_cells)];
  }
  /// Returns the tile for a change: created or copied when needed.
  Tile& own_tile(int column, int row);
  /// Adds evidence, as log-odds or as its 2 p - 1.  Returns whether the state of the cell has changed.
  bool observe(CellState& cell, float evidence, float now_s) const;
  float forgotten(const CellState& cell, float now_s) const;
  template <class Visit>
  void visit_passed(const Vector2d& sensor_W, const Vector2d& end_W, double less_m, Visit visit) const;
  /// Whether the cell was occupied when the field was kept.
  bool is_anchor(int column, int row) const;
  /// Replaces a cell by a neighbor that is part of a surface.  Returns whether there is one.
  bool use_neighbor(int& column, int& row, bool (OccupancyMap::*is_surface)(int, int) const) const;
  /// Computes the field again around the cells whose state has changed.
  void update_field();

  Params params_;
  int columns_, rows_, tile_columns_;
  std::vector<std::shared_ptr<Tile>> tiles_;
  int anchored_shift_ = 8;
  std::vector<std::array<int, 2>> changed_, ends_;              ///< cells, during insert()
  float hit_, miss_, limit_, becomes_occupied_, becomes_free_;  ///< in the unit of CellState::belief
  std::vector<std::array<std::uint8_t, 4>> kernel_;             ///< field by distance in rows and columns
};

}  // namespace autonomy
