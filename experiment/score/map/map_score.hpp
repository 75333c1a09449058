// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "experiment/score/map/grid_map.hpp"
#include "sim/state/state_archive.hpp"

namespace experiment {

/// Present and earlier states of the true cells, with the times of their changes.
class CellHistory {
 public:
  bool started() const { return frame_.width > 0; }
  const MapFrame& frame() const { return frame_; }
  /// Starts the history of the cells of a frame, of which nothing is known until look().
  void start(const MapFrame& frame);
  /// Takes the truth at a time, which must not decrease.  A cell that differs from the last truth has changed since
  /// then.
  void look(const GridMap& truth, double now_s);

  Cell now(std::size_t cell) const { return cells_[cell]; }
  /// Returns whether the cell was ever in this state.
  bool was(std::size_t cell, Cell state) const { return (states_[cell] & 1U << static_cast<unsigned>(state)) != 0; }
  bool has_changed(std::size_t cell) const { return (states_[cell] & (states_[cell] - 1U)) != 0; }
  /// Returns the time of its last change.
  double changed_at_s(std::size_t cell) const { return changed_at_s_[cell]; }
  void visit_state(sim::StateArchive& archive);

 private:
  MapFrame frame_;
  std::vector<Cell> cells_;
  std::vector<std::uint8_t> states_;  ///< bit of each state that the cell has had
  std::vector<float> changed_at_s_;
};

/// Counts of cells, as doubles for figures.
struct CellCounts {
  double observable = 0;      ///< free or occupied
  double unknown = 0;         ///< of these, not known by the map
  double known_free = 0;      ///< of these, known by the map, and free
  double known_occupied = 0;  ///< and occupied
  double hits = 0;            ///< occupied cells with an occupied cell of the map within the tolerance
  double false_occupied = 0;  ///< free cells that the map calls occupied, without an occupied one within the tolerance
  double false_free = 0;      ///< occupied cells that the map calls free, without one of the map within the tolerance
  double known_changed = 0;   ///< known cells that have changed
  double stale = 0;           ///< false cells that are in the map as they once were
  double stale_age_s = 0;     ///< sum of the times since these changed

  /// Intersection over union of the occupied cells; NaN without any.
  double iou() const {
    const double all = hits + false_occupied + false_free;
    return all > 0 ? hits / all : std::numeric_limits<double>::quiet_NaN();
  }
  void visit_state(sim::StateArchive& archive) {
    archive(observable, unknown, known_free, known_occupied, hits, false_occupied, false_free, known_changed, stale,
            stale_age_s);
  }
};

struct MapScores {
  CellCounts all;
  CellCounts still;  ///< of cells that have not changed, nor any within the tolerance
};

/// Compares a map with the truth at the last look().  Both have the same frame.  An occupied cell of either map is
/// right when the other has one at most `tolerance` columns and rows away.  Solid cells of the truth do not count.
MapScores score_map(const GridMap& map, const CellHistory& truth, int tolerance, double now_s);

}  // namespace experiment
