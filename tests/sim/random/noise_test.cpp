// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/state_hash_of.hpp"

namespace {

using sim::Noise;
using sim::NoiseParams;
using sim::Random;

struct Moments {
  double mean = 0;
  double variance = 0;
};

Moments moments_of(const std::vector<double>& samples) {
  Moments moments;
  for (const double sample : samples) moments.mean += sample / static_cast<double>(samples.size());
  for (const double sample : samples)
    moments.variance += (sample - moments.mean) * (sample - moments.mean) / static_cast<double>(samples.size());
  return moments;
}

/// What becomes of `truth` at each of `n` steps of `dt_s`.
std::vector<double> series(const NoiseParams& params, double truth, int n, double dt_s, const char* name = "test") {
  Random random(1, name);
  Noise noise(params, 1, Random(1, std::string(name) + "/bias"));
  std::vector<double> samples;
  for (int i = 0; i < n; ++i) {
    random.begin_step(i);
    double value = truth;
    noise.apply(value, i == 0 ? 0 : dt_s, random);
    samples.push_back(value);
  }
  return samples;
}

/// The error of many instruments after one reading at 0 and `steps` readings every `dt_s`.
std::vector<double> ensemble(const NoiseParams& params, int instruments, int steps, double dt_s) {
  std::vector<double> errors(static_cast<std::size_t>(instruments));
  Random random(1, "ensemble");
  Noise noise(params, instruments, Random(1, "ensemble/bias"));
  for (int i = 0; i <= steps; ++i) {
    random.begin_step(i);
    std::fill(errors.begin(), errors.end(), 0.0);
    noise.apply(errors, i == 0 ? 0 : dt_s, random);
  }
  return errors;
}

// A mean of n samples scatters by s / sqrt(n), their variance by s^2 sqrt(2 / n) when they are normal; five
// times that is allowed.
constexpr int n = 40000;
double mean_bound(double std) {
  return 5 * std / std::sqrt(n);
}
double variance_bound(double std) {
  return 5 * std * std * std::sqrt(2.0 / n);
}

TEST(Noise, OffMeansTheTruth) {
  EXPECT_FALSE(NoiseParams().any());
  for (const double sample : series({}, 1.25, 10, 0.1)) EXPECT_EQ(sample, 1.25);
}

TEST(Noise, ScaleErrorAndBiasAreExact) {
  NoiseParams params;
  params.scale_error = 0.5;
  params.bias = 0.25;
  EXPECT_TRUE(params.any());
  for (const double sample : series(params, 2, 3, 0.1)) EXPECT_EQ(sample, 2 * 1.5 + 0.25);
}

TEST(Noise, BiasIsDrawnOnceForEachValue) {
  NoiseParams params;
  params.bias = 3;
  params.bias_std = 2;
  const std::vector<double> run = series(params, 0, 5, 0.1);
  for (const double sample : run) EXPECT_EQ(sample, run.front());
  const Moments over_instruments = moments_of(ensemble(params, n, 0, 0));
  EXPECT_NEAR(over_instruments.mean, 3, mean_bound(2));
  EXPECT_NEAR(over_instruments.variance, 4, variance_bound(2));
}

TEST(Noise, GaussianHasItsMeanAndVarianceAndNoMemory) {
  NoiseParams params;
  params.gaussian_std = 0.3;
  const std::vector<double> run = series(params, 10, n, 0.1);
  const Moments moments = moments_of(run);
  EXPECT_NEAR(moments.mean, 10, mean_bound(0.3));
  EXPECT_NEAR(moments.variance, 0.09, variance_bound(0.3));
  double lag_one = 0;
  for (int i = 1; i < n; ++i) lag_one += (run[i] - 10) * (run[i - 1] - 10) / n;
  EXPECT_NEAR(lag_one, 0, 5 * 0.09 / std::sqrt(n));
}

TEST(Noise, UniformFillsItsWidth) {
  NoiseParams params;
  params.uniform_half_width = 0.6;
  const std::vector<double> run = series(params, 0, n, 0.1);
  const double std = 0.6 / std::sqrt(3.0);
  EXPECT_NEAR(moments_of(run).mean, 0, mean_bound(std));
  EXPECT_NEAR(moments_of(run).variance, std * std, variance_bound(std));  // flatter than normal: a wide bound
  EXPECT_LE(*std::max_element(run.begin(), run.end()), 0.6);
  EXPECT_GT(*std::max_element(run.begin(), run.end()), 0.6 * 0.999);
  EXPECT_LT(*std::min_element(run.begin(), run.end()), -0.6 * 0.999);
}

TEST(Noise, RandomWalkGrowsWithTheSquareRootOfTime) {
  NoiseParams params;
  params.random_walk_std = 0.2;
  EXPECT_EQ(moments_of(ensemble(params, n, 0, 0)).variance, 0);  // it starts at the truth
  EXPECT_NEAR(moments_of(ensemble(params, n, 1, 1.0)).variance, 0.04, variance_bound(0.2));
  EXPECT_NEAR(moments_of(ensemble(params, n, 10, 0.1)).variance, 0.04,
              variance_bound(0.2));  // any step, same growth
  EXPECT_NEAR(moments_of(ensemble(params, n, 90, 0.1)).variance, 9 * 0.04, variance_bound(0.6));
}

TEST(Noise, GaussMarkovIsStationaryFromTheFirstReading) {
  NoiseParams params;
  params.gauss_markov_std = 0.5;
  params.gauss_markov_time_s = 2;
  for (const int steps : {0, 1, 10}) {
    const Moments moments = moments_of(ensemble(params, n, steps, 0.7));
    EXPECT_NEAR(moments.mean, 0, mean_bound(0.5)) << steps;
    EXPECT_NEAR(moments.variance, 0.25, variance_bound(0.5)) << steps;
  }
}

TEST(Noise, GaussMarkovForgetsExponentially) {
  NoiseParams params;
  params.gauss_markov_std = 0.5;
  params.gauss_markov_time_s = 2;
  const int many = 400000;
  const double dt_s = 0.5;
  const std::vector<double> run = series(params, 0, many, dt_s);
  for (const int lag : {1, 2, 4, 8}) {
    double covariance = 0;
    for (int i = lag; i < many; ++i) covariance += run[i] * run[i - lag] / (many - lag);
    // Bartlett's formula: the variance of a sample autocovariance of this process is below
    // s^4 2 (1 + a^2) / (1 - a^2) / n with a the correlation from one sample to the next.
    const double a = std::exp(-dt_s / 2);
    const double bound = 5 * 0.25 * std::sqrt(2 * (1 + a * a) / (1 - a * a) / many);
    EXPECT_NEAR(covariance, 0.25 * std::exp(-lag * dt_s / 2), bound) << lag;
  }
}

TEST(Noise, GaussMarkovIsTheSameForAnyRate) {
  NoiseParams params;
  params.gauss_markov_std = 1;
  params.gauss_markov_time_s = 5;
  // The correlation over one second, from readings every second and every 50 ms.
  for (const int readings : {1, 20}) {
    Random random(1, "rate");
    Noise noise(params, n, Random(1, "rate/bias"));
    std::vector<double> first(n), last(n);
    noise.apply(first, 0, random);
    for (int i = 0; i < readings; ++i) {
      std::fill(last.begin(), last.end(), 0.0);
      noise.apply(last, 1.0 / readings, random);
    }
    double product = 0;
    for (int i = 0; i < n; ++i) product += first[i] * last[i] / n;
    EXPECT_NEAR(product, std::exp(-1.0 / 5), 5 * std::sqrt(2.0 / n)) << readings;
  }
}

TEST(Noise, OutliersComeAsOftenAndAsFarAsSaid) {
  NoiseParams params;
  params.outlier_probability = 0.1;
  params.outlier_std = 4;
  const std::vector<double> run = series(params, 1, n, 0.1);
  const auto outliers = std::count_if(run.begin(), run.end(), [](double sample) { return sample != 1; });
  EXPECT_NEAR(static_cast<double>(outliers) / n, 0.1, 5 * std::sqrt(0.1 * 0.9 / n));
  // E x^2 = p s^2, E x^4 = 3 p s^4: the variance of x^2 is 3 p s^4 - p^2 s^4.
  EXPECT_NEAR(moments_of(run).variance, 1.6, 5 * 16 * std::sqrt((0.3 - 0.01) / n));
}

TEST(Noise, QuantizationRoundsToTheNearestStep) {
  NoiseParams params;
  params.quantization = 0.25;
  EXPECT_EQ(series(params, 1.1, 1, 0).front(), 1.0);
  EXPECT_EQ(series(params, 1.13, 1, 0).front(), 1.25);
  EXPECT_EQ(series(params, -1.13, 1, 0).front(), -1.25);
}

TEST(Noise, SaturationCutsBothEnds) {
  NoiseParams params;
  params.saturation = 2;
  EXPECT_EQ(series(params, 5, 1, 0).front(), 2);
  EXPECT_EQ(series(params, -5, 1, 0).front(), -2);
  EXPECT_EQ(series(params, std::numeric_limits<double>::infinity(), 1, 0).front(), 2);
}

TEST(Noise, PartsComposeInTheDocumentedOrder) {
  NoiseParams params;
  params.scale_error = 0.1;
  params.bias = 0.07;
  params.quantization = 0.5;
  params.saturation = 5.3;
  EXPECT_EQ(series(params, 1, 1, 0).front(), 1.0);   // 1.17 rounded to a half
  EXPECT_EQ(series(params, 10, 1, 0).front(), 5.3);  // cut after rounding: not a multiple of the step
}

TEST(Noise, OneSlowStateServesAllBeams) {
  NoiseParams params;
  params.bias_std = 1;
  params.gauss_markov_std = 1;
  Random random(1, "scan");
  Noise noise(params, 1, Random(1, "bias"));
  std::vector<double> beams(100, 7.0);
  noise.apply(beams, 0, random);
  EXPECT_NE(beams.front(), 7.0);
  for (const double beam : beams) EXPECT_EQ(beam, beams.front());
}

TEST(Noise, EachAxisHasASlowStateOfItsOwn) {
  NoiseParams params;
  params.bias_std = 1;
  Random random(1, "imu");
  Noise noise(params, 3, Random(1, "bias"));
  std::vector<double> values(6, 0.0);
  noise.apply(values, 0, random);
  EXPECT_NE(values[0], values[1]);
  EXPECT_NE(values[1], values[2]);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(values[i], values[i + 3]);
}

TEST(Noise, TwoDevicesAreUncorrelated) {
  NoiseParams params;
  params.gaussian_std = 1;
  const std::vector<double> a = series(params, 0, n, 0.1, "auv1/imu");
  const std::vector<double> b = series(params, 0, n, 0.1, "auv1/dvl");
  double product = 0;
  for (int i = 0; i < n; ++i) product += a[i] * b[i] / n;
  EXPECT_NEAR(product, 0, 5 / std::sqrt(n));
}

TEST(Noise, TheHashSeesTheSlowState) {
  NoiseParams params;
  params.random_walk_std = 1;
  Random random(1, "hash");
  Noise noise(params, 1, Random(1, "bias"));
  const auto hash_of = [&noise] { return test::state_hash_of(noise); };
  double value = 0;
  noise.apply(value, 0, random);
  const std::uint64_t before = hash_of();
  EXPECT_EQ(hash_of(), before);
  noise.apply(value, 0.1, random);
  EXPECT_NE(hash_of(), before);
}

TEST(Noise, RestoredWithOtherParametersItKeepsWhatWasDrawnOnly) {
  NoiseParams params;
  params.bias = 5;
  params.bias_std = 1;
  Noise original(params, 1, Random(1, "bias"));
  sim::StateArchive saver = sim::StateArchive::saver();
  saver(original);
  const std::vector<std::byte> bytes = saver.take_bytes();
  Random random(1, "values");
  double before = 0, after = 0;
  original.apply(before, 0, random);
  params.bias = 7;
  params.bias_std = 0;
  Noise restored(params, 1, Random(1, "bias"));
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  restorer(restored);
  restored.apply(after, 0, random);
  EXPECT_NE(before, 5);
  EXPECT_NEAR(after, before + 2, 1e-12);
}

NoiseParams read(const std::string& yaml, std::string& errors) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, "n.yaml", diagnostics);
  NoiseParams params;
  sim::ParamReader in(node, "noise", diagnostics);
  params.read(in);
  in.finish();
  for (const std::string& line : diagnostics.lines()) errors += line + "\n";
  return params;
}

TEST(NoiseParams, AreReadByTheirNames) {
  std::string errors;
  const NoiseParams params = read(
      "{scale_error: 1, bias: 2, bias_std: 3, random_walk_std: 4, gauss_markov_std: 5, gauss_markov_time_s: "
      "6, "
      "gaussian_std: 7, uniform_half_width: 8, outlier_probability: 0.9, outlier_std: 10, quantization: 11, "
      "saturation: 12}",
      errors);
  EXPECT_EQ(errors, "");
  EXPECT_EQ(params.scale_error, 1);
  EXPECT_EQ(params.bias, 2);
  EXPECT_EQ(params.bias_std, 3);
  EXPECT_EQ(params.random_walk_std, 4);
  EXPECT_EQ(params.gauss_markov_std, 5);
  EXPECT_EQ(params.gauss_markov_time_s, 6);
  EXPECT_EQ(params.gaussian_std, 7);
  EXPECT_EQ(params.uniform_half_width, 8);
  EXPECT_EQ(params.outlier_probability, 0.9);
  EXPECT_EQ(params.outlier_std, 10);
  EXPECT_EQ(params.quantization, 11);
  EXPECT_EQ(params.saturation, 12);
}

TEST(NoiseParams, KnowTheKeyTheyWereReadByWhetherItIsThereOrNot) {
  struct Params {
    NoiseParams range_noise, bearing_noise;
    void read(sim::ParamReader& in) {
      in.read("range_noise", range_noise, "error of the range");
      in.read("bearing_noise", bearing_noise, "error of the bearing");
    }
  } params;
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text("range_noise: {bias: 2}", "n.yaml", diagnostics);
  sim::ParamReader in(node, "device", diagnostics);
  params.read(in);
  in.finish();
  EXPECT_TRUE(diagnostics.lines().empty());
  EXPECT_STREQ(params.range_noise.key, "range_noise");
  EXPECT_STREQ(params.bearing_noise.key, "bearing_noise");
}

TEST(NoiseOf, IsMadeOfItsMemberAndChangesWithIt) {
  struct Params {
    NoiseParams first, second;
  } params;
  struct Context {
    Noise noise(const NoiseParams& of, int values) const { return {of, values, Random(1, "d#q")}; }
  };
  params.first.bias = 1;
  params.second.bias = 10;
  sim::NoiseOf<&Params::second> noise(Context{}, params);
  Random random(1, "d");
  double value = 0;
  noise.apply(value, 0, random);
  EXPECT_EQ(value, 10);
  params.second.bias = 20;
  noise.change(params);
  value = 0;
  noise.apply(value, 0, random);
  EXPECT_EQ(value, 20);
}

TEST(NoiseParams, RefuseWhatHasNoMeaning) {
  std::string errors;
  read("gaussian_std: -1\noutlier_probability: 2\ngauss_markov_time_s: 0\n", errors);
  EXPECT_EQ(errors,
            "n.yaml:3:22: noise: 'gauss_markov_time_s' must be > 0, got 0\n"
            "n.yaml:1:15: noise: 'gaussian_std' must be >= 0, got -1\n"
            "n.yaml:2:22: noise: 'outlier_probability' must be >= 0 and <= 1, got 2\n");
}

}  // namespace
