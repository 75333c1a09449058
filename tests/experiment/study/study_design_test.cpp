// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_design.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "experiment/study/study_results.hpp"
#include "experiment/study/study_until.hpp"

namespace {

using testing::ElementsAre;

experiment::StudyFactor range(double from, double to, std::int64_t levels = 3) {
  experiment::StudyFactor factor;
  factor.name = "f";
  factor.paths = {"a.b"};
  factor.from = from;
  factor.to = to;
  factor.levels = levels;
  return factor;
}

experiment::StudyDesign design_of(experiment::StudyDesign::Type type, std::int64_t points) {
  experiment::StudyDesign design;
  design.type = type;
  design.points = points;
  return design;
}

TEST(StudyDesign, AGridHasEveryCombinationAndTheLastFactorChangesFirst) {
  experiment::StudyFactor word;
  word.name = "w";
  word.paths = {"c", "d"};
  word.values = {"x", "y"};
  const auto points = experiment::design_points({}, {range(0, 1), word});
  ASSERT_EQ(points.size(), 6u);
  EXPECT_THAT(points[0].values, ElementsAre("0", "x"));
  EXPECT_THAT(points[1].values, ElementsAre("0", "y"));
  EXPECT_THAT(points[2].values, ElementsAre("0.5", "x"));
  EXPECT_THAT(points[5].values, ElementsAre("1", "y"));
  EXPECT_THAT(experiment::point_sets({range(0, 1), word}, points[5]), ElementsAre("a.b=1", "c=y", "d=y"));
}

TEST(StudyDesign, WithoutFactorsThereIsOnePoint) {
  EXPECT_EQ(experiment::design_points({}, {}).size(), 1u);
}

TEST(StudyDesign, RangesMayBeLogarithmicAndWhole) {
  experiment::StudyFactor factor = range(1, 100);
  factor.scale = experiment::StudyFactor::Scale::log;
  const auto points = experiment::design_points({}, {factor});
  EXPECT_EQ(points[0].values[0], "1");
  EXPECT_NEAR(std::stod(points[1].values[0]), 10, 1e-12);
  EXPECT_EQ(points[2].values[0], "100");
  factor.whole = true;
  EXPECT_EQ(experiment::design_points({}, {factor})[1].values[0], "10");
}

TEST(StudyDesign, ALatinHypercubeHasOnePointInEachPartOfEachRange) {
  const auto shares = experiment::design_shares(design_of(experiment::StudyDesign::Type::latin_hypercube, 50), 3);
  ASSERT_EQ(shares.size(), 50u);
  for (std::size_t k = 0; k < 3; ++k) {
    std::set<int> parts;
    for (const auto& point : shares) parts.insert(static_cast<int>(point[k] * 50));
    EXPECT_EQ(parts.size(), 50u) << k;
    EXPECT_EQ(*parts.rbegin(), 49);
  }
  EXPECT_EQ(shares, experiment::design_shares(design_of(experiment::StudyDesign::Type::latin_hypercube, 50), 3));
}

TEST(StudyDesign, TheSequenceOfSobolStartsAsPublished) {
  // Joe and Kuo's direction numbers; the first point, 0, is left out.
  const auto shares = experiment::design_shares(design_of(experiment::StudyDesign::Type::sobol, 4), 2);
  EXPECT_THAT(shares, ElementsAre(ElementsAre(0.5, 0.5), ElementsAre(0.75, 0.25), ElementsAre(0.25, 0.75),
                                  ElementsAre(0.375, 0.375)));
  // With the point 0, each eighth of each range has one of eight points.
  const auto seven = experiment::design_shares(design_of(experiment::StudyDesign::Type::sobol, 7), 5);
  for (std::size_t k = 0; k < 5; ++k) {
    std::set<int> parts{0};
    for (const auto& point : seven) parts.insert(static_cast<int>(point[k] * 8));
    EXPECT_EQ(parts.size(), 8u) << k;
  }
}

TEST(StudyDesign, RandomPointsDependOnTheirSeedOnly) {
  experiment::StudyDesign design = design_of(experiment::StudyDesign::Type::random, 1000);
  const auto shares = experiment::design_shares(design, 1);
  double sum = 0;
  for (const auto& point : shares) sum += point[0];
  EXPECT_NEAR(sum / 1000, 0.5, 4 * std::sqrt(1.0 / 12 / 1000));
  design.points = 10;
  const auto first = experiment::design_shares(design, 1);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), shares.begin()));
  design.seed = 2;
  EXPECT_NE(experiment::design_shares(design, 1), first);
}

}  // namespace
