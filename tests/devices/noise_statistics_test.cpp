// SPDX-License-Identifier: BSD-3-Clause
// What sim::Noise does to a device's reports, measured on the reports.
#include "shoal/imu_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// 100 Hz from a box at rest, for `time_s`.  axis[i][k]: rate k about axis i.
std::vector<std::vector<double>> gyro_record(const std::string& noise, double time_s) {
  test::TestWorld test(
      test::box_world("        - {name: imu, type: imu, rate_hz: 100, phase_s: 0, gyro_noise: " + noise + "}\n",
                      "{step_s: 0.01, gravity_mps2: 0}"));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(time_s);
  std::vector<std::vector<double>> axes(3);
  for (const auto& report : reports.take_all())
    for (std::size_t i = 0; i < 3; ++i) axes[i].push_back(report.angular_velocity_radps[i]);
  return axes;
}

TEST(NoiseStatistics, WhiteNoiseHasNoMemory) {
  const auto axes = gyro_record("{gaussian_std: 0.1}", 200);
  double squares = 0, products = 0, mean = 0;
  const double n = 3.0 * static_cast<double>(axes[0].size());
  for (const auto& axis : axes)
    for (std::size_t k = 0; k + 1 < axis.size(); ++k) {
      mean += axis[k] / n;
      squares += axis[k] * axis[k] / n;
      products += axis[k] * axis[k + 1] / n;
    }
  EXPECT_NEAR(mean, 0, 4 * 0.1 / std::sqrt(n));
  EXPECT_NEAR(squares, 0.01, 4 * 0.01 * std::sqrt(2 / n));
  EXPECT_NEAR(products, 0, 4 * 0.01 / std::sqrt(n));
}

TEST(NoiseStatistics, GaussMarkovForgets63PercentInItsCorrelationTime) {
  const double time_s = 900, correlation_s = 0.5;
  const auto axes = gyro_record("{gauss_markov_std: 0.2, gauss_markov_time_s: 0.5}", time_s);
  constexpr std::size_t lag = 50;  // the correlation time at 100 Hz
  double squares = 0, products = 0, count = 0;
  for (const auto& axis : axes)
    for (std::size_t k = 0; k + lag < axis.size(); ++k, ++count) {
      squares += axis[k] * axis[k];
      products += axis[k] * axis[k + lag];
    }
  // The square of the process forgets in T / 2, so that its mean over a time t has a relative variance of 2 T / t; the
  // product at a lag has no more.
  const double relative_error = std::sqrt(2 * correlation_s / (3 * time_s));
  EXPECT_NEAR(squares / count, 0.04, 4 * relative_error * 0.04);
  EXPECT_NEAR(products / squares, std::exp(-1.0), 4 * relative_error);
}

TEST(NoiseStatistics, TheVarianceOfARandomWalkGrowsWithTime) {
  // 0.03 after 1 s.  Increments over 1 s and over 9 s of one long walk: 1 and 9 times the variance.
  const auto axes = gyro_record("{random_walk_std: 0.03}", 600);
  for (const std::size_t span_s : {1u, 9u}) {
    double squares = 0, count = 0;
    for (const auto& axis : axes)
      for (std::size_t k = 0; k + span_s * 100 < axis.size(); k += span_s * 100, ++count)
        squares += std::pow(axis[k + span_s * 100] - axis[k], 2);
    const double expected = 0.03 * 0.03 * static_cast<double>(span_s);
    EXPECT_NEAR(squares / count, expected, 4 * expected * std::sqrt(2 / count)) << span_s;
  }
}

}  // namespace
