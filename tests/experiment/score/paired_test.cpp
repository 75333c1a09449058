// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/paired.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

TEST(MedianInterval, LiesBetweenOrderStatisticsOfTheSameRank) {
  // Of six values P(at most 0 of 6) = 1/64 < 0.025 < P(at most 1 of 6) = 7/64: the smallest and the largest.
  const experiment::Interval six = experiment::median_interval_95({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(six.low, 1);
  EXPECT_EQ(six.high, 6);
  // Of ten: P(at most 1) = 11/1024 = 0.0107, P(at most 2) = 56/1024 = 0.0547: the second from both ends.
  const experiment::Interval ten = experiment::median_interval_95({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  EXPECT_EQ(ten.low, 2);
  EXPECT_EQ(ten.high, 9);
  EXPECT_TRUE(std::isnan(experiment::median_interval_95({1, 2, 3, 4, 5}).low));
}

TEST(SignTest, CountsTossesOfAFairCoin) {
  EXPECT_DOUBLE_EQ(experiment::sign_test(0, 0), 1);
  EXPECT_NEAR(experiment::sign_test(5, 0), 2.0 / 32, 1e-12);
  EXPECT_NEAR(experiment::sign_test(1, 9), 2.0 * 11 / 1024, 1e-12);
  EXPECT_DOUBLE_EQ(experiment::sign_test(4, 4), 1);
}

TEST(WilcoxonTest, CountsSubsetsOfRanks) {
  // All positive: only the empty subset has a negative rank sum of 0.
  EXPECT_NEAR(experiment::wilcoxon_test({1, 2, 3, 4, 5, 6}), 2.0 / 64, 1e-12);
  // Rank 5 is negative; subsets of 1 to 5 with a sum of at most 5: sums 0 to 5 have 1, 1, 1, 2, 2 and 3 of them.
  EXPECT_NEAR(experiment::wilcoxon_test({1, 2, 3, 4, -5}), 2.0 * 10 / 32, 1e-12);
  EXPECT_NEAR(experiment::wilcoxon_test({0, 1, 2, 0, 3, 4, -5}), 2.0 * 10 / 32, 1e-12);
  EXPECT_DOUBLE_EQ(experiment::wilcoxon_test({0, 0}), 1);
}

TEST(WilcoxonTest, IsExactForTies) {
  // Four of +1, one of -1: each rank is 3, and at most one of five tosses is heads in 6 of 32 cases.
  EXPECT_NEAR(experiment::wilcoxon_test({1, 1, 1, 1, -1}), 2.0 * 6 / 32, 1e-12);
  // Ranks 1.5, 1.5, 3.5, 3.5, 5, of which one of 1.5 is negative: three subsets have a sum of at most 1.5.
  EXPECT_NEAR(experiment::wilcoxon_test({-1, 1, 2, 2, 3}), 2.0 * 3 / 32, 1e-12);
  // Ranks 2, 2, 2, 4, of which 4 is negative: the sums 0, 2, 2, 2, 4, 4, 4, 4 are at most 4; doubled that is 1.
  EXPECT_DOUBLE_EQ(experiment::wilcoxon_test({1, 1, 1, -2}), 1);
}

TEST(WilcoxonTest, CountsTheSignsOfTwentyTiedDifferences) {
  // Sizes 1, 1, 2, 2, ... 10, 10 have the ranks 1.5, 1.5, 3.5, 3.5, ...; two of the smaller ones are negative.
  std::vector<double> differences, ranks;
  for (int i = 0; i < 20; ++i) {
    differences.push_back((i == 0 || i == 5 ? -1 : 1) * (1 + i / 2));
    ranks.push_back(2 * (i / 2) + 1.5);
  }
  const double smaller = ranks[0] + ranks[5];
  std::size_t as_small = 0;
  for (unsigned signs = 0; signs < 1u << 20; ++signs) {
    double sum = 0;
    for (unsigned i = 0; i < 20; ++i) sum += (signs >> i & 1u) != 0 ? ranks[i] : 0;
    as_small += sum <= smaller;
  }
  EXPECT_NEAR(experiment::wilcoxon_test(differences), 2.0 * static_cast<double>(as_small) / (1 << 20), 1e-12);
}

TEST(WilcoxonTest, UsesTheNormalDistributionForManyDifferences) {
  // Both branches agree for many values: 50 differences exactly, 51 by the normal distribution.
  std::vector<double> differences;
  for (int i = 1; i <= 50; ++i) differences.push_back(i % 3 == 0 ? -i : i);
  const double exact = experiment::wilcoxon_test(differences);
  differences.push_back(1e-9);  // the smallest rank
  EXPECT_NEAR(experiment::wilcoxon_test(differences), exact, 0.003);
}

TEST(PairedComparison, TakesTheDifferencesOfPairs) {
  const experiment::PairedComparison c = experiment::compare_pairs({1, 3, -1, 0, 2});
  EXPECT_EQ(c.pairs, 5u);
  EXPECT_DOUBLE_EQ(c.mean, 1);
  EXPECT_DOUBLE_EQ(c.median, 1);
  EXPECT_EQ(c.higher, 3u);
  EXPECT_EQ(c.lower, 1u);
  EXPECT_EQ(c.equal, 1u);
  EXPECT_NEAR(c.sign_p, 2.0 * 5 / 16, 1e-12);  // at most 1 of 4 tosses
  // Squares about 1: 0, 4, 4, 1, 1; t of 4 degrees of freedom is 2.77645.
  EXPECT_NEAR(c.mean_95.high - 1, 2.77645 * std::sqrt(10.0 / 4 / 5), 1e-4);
  EXPECT_TRUE(std::isnan(experiment::compare_pairs({}).mean));
  EXPECT_TRUE(std::isnan(experiment::compare_pairs({1}).mean_95.low));
}

}  // namespace
