// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/occupancy_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace {

using autonomy::OccupancyMap;
using autonomy::Vector2d;

OccupancyMap::Params small(bool forgets = true) {
  OccupancyMap::Params params;
  params.low_W = {-1, -1};
  params.high_W = {3, 1};
  params.cell_m = 0.1;
  params.forgets = forgets;
  return params;
}

/// One beam along x from (0.05, 0.05), to the middle of the cell of `x_m`.
void look(OccupancyMap& map, double x_m, bool hit, double now_s) {
  map.insert({0.05, 0.05}, {{x_m, 0.05}}, {static_cast<char>(hit)}, now_s);
}

int percent_at(const OccupancyMap& map, double x_m, double now_s) {
  return map.percent(map.column_of(x_m), map.row_of(0.05), now_s);
}

TEST(OccupancyMap, OneBeamAddsItsEvidenceByBayesRule) {
  for (const bool forgets : {true, false}) {
    OccupancyMap map(small(forgets));
    look(map, 1.05, true, 0);
    // 1 / (1 + e^-0.85) and 1 / (1 + e^0.4).
    EXPECT_EQ(percent_at(map, 1.05, 0), 70);
    EXPECT_EQ(percent_at(map, 0.55, 0), 40);
    EXPECT_EQ(percent_at(map, 1.25, 0), OccupancyMap::unknown_percent);
    look(map, 1.05, true, 1);
    // Twice the log-odds: 1 / (1 + e^-1.7).
    EXPECT_EQ(percent_at(map, 1.05, 1), 85);
    EXPECT_EQ(percent_at(map, 0.55, 1), 31);
  }
}

TEST(OccupancyMap, ForgetsExponentiallyByTheDwellTime) {
  OccupancyMap::Params params = small();
  params.dwell_s = 1000;
  OccupancyMap map(params);
  for (int i = 0; i < 10; ++i) look(map, 1.05, true, 0);
  // The limit is 3.5: p = 0.9707.  After T ln(2) / 2 the rest of p - 1/2 is the half.
  EXPECT_EQ(percent_at(map, 1.05, 0), 97);
  EXPECT_EQ(percent_at(map, 1.05, 500 * std::log(2)), 74);
  EXPECT_EQ(percent_at(map, 1.05, 1e6), 50);
  OccupancyMap keeps(small(false));
  look(keeps, 1.05, true, 0);
  EXPECT_EQ(percent_at(keeps, 1.05, 1e6), 70);
}

TEST(OccupancyMap, LearnsThatACellThatChangesLastsShorter) {
  OccupancyMap::Params params = small();
  params.dwell_s = 10000;
  params.min_dwell_s = 100;
  OccupancyMap map(params);
  // Occupied, free, occupied: two changes in 2000 s, besides the first sight.
  for (const auto& [from_s, hit] : {std::pair{0.0, true}, {1000.0, false}, {2000.0, true}})
    for (int i = 0; i < 20; ++i) look(map, hit ? 1.05 : 2.05, true, from_s);
  // T = (10000 + 2000) / (1 + 2): 0.9707 falls to 1/2 + 0.4707 exp(-2 * 1000 / 4000).
  EXPECT_EQ(percent_at(map, 1.05, 3000), static_cast<int>(std::lround(50 + 47.07 * std::exp(-0.5))));
}

TEST(OccupancyMap, WithoutForgettingAChangeNeedsAsManyBeamsAsWentBefore) {
  OccupancyMap keeps(small(false)), forgets(small());
  for (OccupancyMap* map : {&keeps, &forgets}) {
    for (int i = 0; i < 1000; ++i) look(*map, 1.05, true, i);
    for (int i = 0; i < 100; ++i) look(*map, 2.05, true, 1000 + i);
  }
  EXPECT_EQ(percent_at(keeps, 1.05, 1100), 100);
  EXPECT_LT(percent_at(forgets, 1.05, 1100), 20);
}

TEST(OccupancyMap, FieldIsAGaussianOfTheDistanceToTheNearestOccupiedCell) {
  OccupancyMap map(small());
  look(map, 1.05, true, 0);
  EXPECT_NEAR(map.field({1.05, 0.05}), 1, 0.003);  // eight bits
  const double one_cell = std::exp(-0.5 * std::pow(0.1 / map.params().field_std_m, 2));
  EXPECT_NEAR(map.field({1.15, 0.05}), one_cell, 0.003);
  EXPECT_NEAR(map.field({1.10, 0.05}), (1 + one_cell) / 2, 0.003);  // between two centers
  EXPECT_EQ(map.field({1.95, 0.05}), 0);
  EXPECT_EQ(map.field({1e9, 0}), 0);
  // Free again, it has no field.
  for (int i = 0; i < 20; ++i) look(map, 2.05, true, 1);
  EXPECT_EQ(map.field({1.05, 0.05}), 0);
}

TEST(OccupancyMap, ACopyKeepsItsStateWhenTheOriginalGoesOn) {
  OccupancyMap map(small());
  look(map, 1.05, true, 0);
  const OccupancyMap copy = map;
  for (int i = 0; i < 20; ++i) look(map, 2.05, true, 1);
  EXPECT_EQ(percent_at(copy, 1.05, 0), 70);
  EXPECT_LT(percent_at(map, 1.05, 1), 20);
  EXPECT_NEAR(copy.field({1.05, 0.05}), 1, 0.003);
}

TEST(OccupancyMap, BeamsOutsideOfItsAreaDoNothing) {
  OccupancyMap map(small());
  map.insert({10, 10}, {{12, 10}, {-5, -5}}, {1, 1}, 0);
  map.insert({0, 0}, {{100, 0}}, {1}, 0);
  EXPECT_EQ(map.percent(map.columns() - 1, map.row_of(0), 0), 40);
}

TEST(OccupancyMap, RefusesEmptyAndHugeAreas) {
  OccupancyMap::Params params = small();
  params.high_W = {-1, 2};
  EXPECT_THROW(OccupancyMap{params}, std::invalid_argument);
  params.high_W = {1e5, 1e5};
  EXPECT_THROW(OccupancyMap{params}, std::invalid_argument);
}

TEST(OccupancyMap, AKeptSurfaceStaysInItsCell) {
  OccupancyMap map(small());
  for (int i = 0; i < 5; ++i) look(map, 1.05, true, 0);
  map.anchor();
  // Poses off by a cell for long: the surface does not creep.
  for (int i = 0; i < 100; ++i) look(map, 1.15, true, 10 * i);
  EXPECT_GT(percent_at(map, 1.05, 1000), 90);
  EXPECT_EQ(percent_at(map, 1.15, 1000), OccupancyMap::unknown_percent);
  // Something else behind it: it has gone from the map, and stays in the field.
  for (int i = 0; i < 100; ++i) look(map, 1.55, true, 1000 + 10 * i);
  EXPECT_LT(percent_at(map, 1.05, 2000), 10);
  EXPECT_GT(percent_at(map, 1.55, 2000), 90);
  EXPECT_EQ(map.field_at(map.column_of(1.05), map.row_of(0.05)), 255);
  EXPECT_EQ(map.field_at(map.column_of(1.55), map.row_of(0.05)), 255 - 255 / 8);
}

}  // namespace
