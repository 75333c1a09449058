// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/random.hpp"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace {

using sim::Random;

// Sample figures of n draws scatter with standard deviation s / sqrt(n); five of those is a bound that a
// right generator misses once in two million seeds, and the seed here is fixed.
double five_sigma(double standard_deviation, int n) {
  return 5 * standard_deviation / std::sqrt(n);
}

TEST(Random, PhiloxGivesTheKnownAnswers) {
  // kat_vectors of Random123 1.09, philox4x32 with 10 rounds.
  using Philox = r123::Philox4x32_R<10>;
  const Philox philox;
  EXPECT_EQ(philox(Philox::ctr_type{{0, 0, 0, 0}}, Philox::key_type{{0, 0}}),
            (Philox::ctr_type{{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox(Philox::ctr_type{{ones, ones, ones, ones}}, Philox::key_type{{ones, ones}}),
            (Philox::ctr_type{{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}}));
  EXPECT_EQ(philox(Philox::ctr_type{{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}},
                   Philox::key_type{{0xa4093822, 0x299f31d0}}),
            (Philox::ctr_type{{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}));
}

TEST(Random, HashIsFnv1a) {
  // Test vectors of draft-eastlake-fnv.
  EXPECT_EQ(sim::hash_text(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(sim::hash_text("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(sim::hash_text("foobar"), 0x85944171f73967e8ULL);
}

TEST(Random, AStreamStaysTheSameFromVersionToVersion) {
  // Recorded: a change here changes every run that users have on file.
  Random random(1, "auv1/lidar");
  random.begin_step(7);
  EXPECT_EQ(random.bits(), 0x5af9852528f13b9cULL);
  EXPECT_EQ(random.bits(), 0xc264456b3030fb8cULL);
  EXPECT_EQ(random.bits(), 0x20e89cc35fb9781aULL);
}

std::vector<std::uint64_t> draws(std::uint64_t seed, const char* name, std::int64_t step, int n) {
  Random random(seed, name);
  random.begin_step(step);
  std::vector<std::uint64_t> bits;
  for (int i = 0; i < n; ++i) bits.push_back(random.bits());
  return bits;
}

TEST(Random, AStepDrawsTheSameWhateverWasDrawnBefore) {
  Random random(1, "a");
  for (int step = 0; step < 5; ++step) {
    random.begin_step(step);
    for (int i = 0; i < step * 3; ++i) random.gaussian();
  }
  random.begin_step(9);
  for (const std::uint64_t expected : draws(1, "a", 9, 10)) EXPECT_EQ(random.bits(), expected);
}

TEST(Random, AStreamDoesNotFeelAnother) {
  Random a(1, "a"), b(1, "b");
  a.begin_step(0);
  b.begin_step(0);
  std::vector<std::uint64_t> interleaved;
  for (int i = 0; i < 10; ++i) {
    interleaved.push_back(a.bits());
    for (int j = 0; j < i; ++j) b.bits();
  }
  EXPECT_EQ(interleaved, draws(1, "a", 0, 10));
}

TEST(Random, SeedNameStepAndDrawAllChangeTheBits) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const char* name : {"", "a", "b", "auv1/a", "auv2/a"})
      for (const std::int64_t step : {-1LL, 0LL, 1LL, 1LL << 32, (1LL << 32) + 1})
        for (const std::uint64_t bits : draws(seed, name, step, 20)) seen.insert(bits);
  // Two equal among 5000 of 2^64 would be a chance of 1e-12.
  EXPECT_EQ(seen.size(), 10u * 5 * 5 * 20);
}

TEST(Random, StreamsOfNeighboringNamesAreUncorrelated) {
  Random a(1, "robot1/imu"), b(1, "robot2/imu");
  const int n = 100000;
  double product = 0;
  for (int i = 0; i < n; ++i) {
    a.begin_step(i);
    b.begin_step(i);
    product += a.gaussian() * b.gaussian();
  }
  EXPECT_NEAR(product / n, 0, five_sigma(1, n));  // the product of two standard normals has variance 1
}

TEST(Random, UniformHasTheMomentsOfTheUnitInterval) {
  Random random(1, "u");
  const int n = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    sum += u - 0.5;
    squares += (u - 0.5) * (u - 0.5);
  }
  EXPECT_NEAR(sum / n, 0, five_sigma(std::sqrt(1.0 / 12), n));
  EXPECT_NEAR(squares / n, 1.0 / 12, five_sigma(std::sqrt(1.0 / 180), n));  // 1/80 - 1/144
}

TEST(Random, GaussianHasTheMomentsOfTheNormalDistribution) {
  Random random(1, "g");
  const int n = 200000;
  double sum = 0, squares = 0, fourth = 0;
  int beyond_three = 0;
  for (int i = 0; i < n; ++i) {
    const double g = random.gaussian();
    sum += g;
    squares += g * g;
    fourth += g * g * g * g;
    beyond_three += std::abs(g) > 3;
  }
  EXPECT_NEAR(sum / n, 0, five_sigma(1, n));
  EXPECT_NEAR(squares / n, 1, five_sigma(std::sqrt(2.0), n));
  EXPECT_NEAR(fourth / n, 3, five_sigma(std::sqrt(96.0), n));  // E g^8 - 9 = 105 - 9
  const double p = 0.0026997960632601866;                      // erfc(3 / sqrt 2)
  EXPECT_NEAR(static_cast<double>(beyond_three) / n, p, five_sigma(std::sqrt(p), n));
}

TEST(Random, IntegersBelowAreEquallyLikely) {
  Random random(1, "i");
  const int n = 70000;
  std::vector<int> count(7);
  for (int i = 0; i < n; ++i) ++count[random.integer_below(7)];
  for (const int c : count) EXPECT_NEAR(c, n / 7.0, 5 * std::sqrt(n / 7.0));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.integer_below(1), 0u);
  // With n = 3 * 2^30 a generator without refusal gives every third value twice as often.
  int low_third = 0;
  for (int i = 0; i < n; ++i) low_third += random.integer_below(3u << 30) < (1u << 30);
  EXPECT_NEAR(low_third, n / 3.0, 5 * std::sqrt(n / 3.0));
}

TEST(NormalQuantile, MeetsKnownQuantiles) {
  // Abramowitz and Stegun, table 26.5, and the digits of the inverse error function.
  EXPECT_EQ(sim::normal_quantile(0.5), 0);
  EXPECT_NEAR(sim::normal_quantile(0.975), 1.9599639845400542, 2e-15);
  EXPECT_NEAR(sim::normal_quantile(0.25), -0.67448975019608174, 1e-15);
  // The three checks of the published algorithm.
  EXPECT_NEAR(sim::normal_quantile(0.001), -3.090232306167813, 4e-15);
  EXPECT_NEAR(sim::normal_quantile(1e-20), -9.262340089798408, 2e-14);
}

TEST(NormalQuantile, IsTheInverseOfTheDistribution) {
  // p = erfc(-x / sqrt 2) / 2 in long double; an error dx shows as density * dx / p, so one Newton step
  // measures it.
  const auto relative_error = [](double p) {
    const long double x = sim::normal_quantile(p);
    const long double distribution = std::erfc(-x / std::numbers::sqrt2_v<long double>) / 2;
    const long double density = std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi_v<long double>);
    return static_cast<double>(std::abs((distribution - p) / density / x));
  };
  for (double p = 1e-300; p < 0.5; p *= 1.037) EXPECT_LT(relative_error(p), 1e-15) << p;
  for (double p = 0.01; p < 0.49; p += 0.001) EXPECT_LT(relative_error(p), 1e-15) << p;
}

TEST(NormalQuantile, IsSymmetric) {
  for (const double p : {0x1p-10, 0x1p-30, 0x1p-52, 0.125, 0.375})  // 1 - p is exact for these
    EXPECT_EQ(sim::normal_quantile(1 - p), -sim::normal_quantile(p));
}

}  // namespace
