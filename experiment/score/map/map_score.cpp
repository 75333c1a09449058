// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/map_score.hpp"

#include <algorithm>
#include <functional>

namespace experiment {

namespace {

/// Marks the cells that are at most `tolerance` columns and rows away from one that `is` true for.
std::vector<std::uint8_t> near(const MapFrame& frame, int tolerance, const std::function<bool(std::size_t)>& is) {
  std::vector<std::uint8_t> marked(frame.size());
  for (int row = 0; row < frame.height; ++row)
    for (int column = 0; column < frame.width; ++column) {
      if (!is(frame.index(column, row))) continue;
      const int first = std::max(0, column - tolerance), last = std::min(frame.width - 1, column + tolerance);
      for (int r = std::max(0, row - tolerance); r <= std::min(frame.height - 1, row + tolerance); ++r)
        std::fill_n(marked.begin() + static_cast<std::ptrdiff_t>(frame.index(first, r)), last - first + 1, 1);
    }
  return marked;
}

/// Adds a cell that the map knows.  `matched`: the other map has an occupied cell within the tolerance.
void count_known(Cell truth, Cell mapped, bool matched, CellCounts& counts) {
  ++(truth == Cell::free ? counts.known_free : counts.known_occupied);
  if (truth == Cell::occupied) ++(matched ? counts.hits : counts.false_free);
  if (truth == Cell::free && mapped == Cell::occupied && !matched) ++counts.false_occupied;
}

}  // namespace

void CellHistory::start(const MapFrame& frame) {
  frame_ = frame;
  cells_.assign(frame.size(), Cell::unknown);
  states_.assign(frame.size(), 0);
  changed_at_s_.assign(frame.size(), 0);
}

void CellHistory::look(const GridMap& truth, double now_s) {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (truth.cells[i] == cells_[i]) continue;
    cells_[i] = truth.cells[i];
    states_[i] |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(truth.cells[i]));
    changed_at_s_[i] = static_cast<float>(now_s);
  }
}

void CellHistory::visit_state(sim::StateArchive& archive) {
  archive(frame_.origin_x_m, frame_.origin_y_m, frame_.cell_m, frame_.width, frame_.height, cells_, states_,
          changed_at_s_);
  if (archive.restoring() &&
      (frame_.width < 0 || frame_.height < 0 || frame_.width > max_map_cells || frame_.height > max_map_cells ||
       cells_.size() != frame_.size() || states_.size() != frame_.size() || changed_at_s_.size() != frame_.size()))
    archive.fail("a cell history whose size differs from that of its map");
}

MapScores score_map(const GridMap& map, const CellHistory& truth, int tolerance, double now_s) {
  const auto near_true = near(map.frame, tolerance, [&](std::size_t i) { return truth.now(i) == Cell::occupied; });
  const auto near_mapped = near(map.frame, tolerance, [&](std::size_t i) { return map.cells[i] == Cell::occupied; });
  const auto near_change = near(map.frame, tolerance, [&](std::size_t i) { return truth.has_changed(i); });
  MapScores scores;
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const Cell actual = truth.now(i), mapped = map.cells[i];
    // No sensor sees into a solid.
    if (actual == Cell::solid || actual == Cell::unknown) continue;
    const bool known = mapped != Cell::unknown;
    const bool matched = (actual == Cell::occupied ? near_mapped : near_true)[i] != 0;
    for (CellCounts* counts : {&scores.all, &scores.still}) {
      // Near a change the tolerance would match the old place, so these cells are not counted as still.
      if (counts == &scores.still && near_change[i] != 0) continue;
      ++counts->observable;
      if (known)
        count_known(actual, mapped, matched, *counts);
      else
        ++counts->unknown;
    }
    if (!known || !truth.has_changed(i)) continue;
    ++scores.all.known_changed;
    const bool wrong = !matched && (actual == Cell::occupied || mapped == Cell::occupied);
    // Only what was once true is stale; anything else is an error of mapping.
    if (!wrong || !truth.was(i, mapped)) continue;
    ++scores.all.stale;
    scores.all.stale_age_s += now_s - static_cast<double>(truth.changed_at_s(i));
  }
  return scores;
}

}  // namespace experiment
