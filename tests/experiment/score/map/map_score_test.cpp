// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/map_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using experiment::Cell;
using experiment::CellHistory;
using experiment::GridMap;

/// A map of one row: `.` free, `#` occupied, `x` solid, `?` unknown.
GridMap row_map(const std::string& text) {
  GridMap map{{0, 0, 0.1, static_cast<int>(text.size()), 1}, {}};
  for (const char c : text)
    map.cells.push_back(c == '#' ? Cell::occupied : c == 'x' ? Cell::solid : c == '?' ? Cell::unknown : Cell::free);
  return map;
}

/// A history of truths, 100 s apart from 0 on.
CellHistory history_of(const std::vector<std::string>& truths) {
  CellHistory history;
  history.start(row_map(truths[0]).frame);
  for (std::size_t i = 0; i < truths.size(); ++i) history.look(row_map(truths[i]), 100.0 * static_cast<double>(i));
  return history;
}

TEST(MapScore, OfTheTruthItselfIsOne) {
  const auto scores = experiment::score_map(row_map("..##?.#"), history_of({"..##x.#"}), 0, 0);
  EXPECT_EQ(scores.all.iou(), 1);
  EXPECT_EQ(scores.all.hits, 3);
  EXPECT_EQ(scores.all.known_free, 3);
  EXPECT_EQ(scores.all.unknown, 0);  // the inside of an object does not count
  EXPECT_EQ(scores.all.observable, 6);
}

TEST(MapScore, CountsEachKindOfCellOnce) {
  // Truth ..##..#.: one hit, one false occupied, one false free, and one occupied and two free cells unknown.
  const auto scores = experiment::score_map(row_map("#.#.??.?"), history_of({"..##..#."}), 0, 0);
  EXPECT_EQ(scores.all.hits, 1);
  EXPECT_EQ(scores.all.false_occupied, 1);
  EXPECT_EQ(scores.all.false_free, 2);
  EXPECT_EQ(scores.all.unknown, 3);
  EXPECT_DOUBLE_EQ(scores.all.iou(), 1.0 / 4);
}

TEST(MapScore, AllowsForTheBordersOfCells) {
  const CellHistory truth = history_of({"...#...."});
  EXPECT_EQ(experiment::score_map(row_map("....#..."), truth, 1, 0).all.iou(), 1);
  EXPECT_EQ(experiment::score_map(row_map("....#..."), truth, 0, 0).all.iou(), 0);
  EXPECT_EQ(experiment::score_map(row_map(".....#.."), truth, 1, 0).all.iou(), 0);
}

TEST(MapScore, WithoutOccupiedCellsHasNoRatio) {
  EXPECT_TRUE(std::isnan(experiment::score_map(row_map("...."), history_of({"...."}), 1, 0).all.iou()));
}

TEST(MapScore, CellsAsTheyOnceWereAreStaleSinceTheirChange) {
  // Cell 1 was occupied until 100 s, cell 5 is since 200 s; the map has both as at 0 s.
  const CellHistory truth = history_of({".#......", "........", ".....#.."});
  const auto scores = experiment::score_map(row_map(".#......"), truth, 0, 250);
  EXPECT_EQ(scores.all.known_changed, 2);
  EXPECT_EQ(scores.all.stale, 2);
  EXPECT_EQ(scores.all.stale_age_s, (250 - 100) + (250 - 200));
  // What never was is false, not stale.
  EXPECT_EQ(experiment::score_map(row_map("...#...."), truth, 0, 250).all.stale, 1);
}

TEST(MapScore, StillCellsAreThoseWithoutAChangeNearby) {
  const CellHistory truth = history_of({"#..#....", "#......."});
  const auto scores = experiment::score_map(row_map("#..#...."), truth, 1, 100);
  EXPECT_EQ(scores.still.iou(), 1);
  EXPECT_EQ(scores.still.observable, 8 - 3);
  EXPECT_EQ(scores.all.iou(), 0.5);
}

TEST(MapScore, HistoryIsRestoredWithItsRun) {
  CellHistory history = history_of({".#..", "...."});
  sim::StateArchive saver = sim::StateArchive::saver();
  saver(history);
  const auto bytes = saver.take_bytes();
  CellHistory restored;
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  restorer(restored);
  EXPECT_TRUE(restored.has_changed(1));
  EXPECT_EQ(restored.changed_at_s(1), 100);
  EXPECT_TRUE(restored.frame() == history.frame());
}

}  // namespace
