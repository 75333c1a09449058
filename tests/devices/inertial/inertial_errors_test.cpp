// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/inertial_errors.hpp"

#include "sim/acoustics/channel.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/random/allan.hpp"
#include "sim/vehicle/device_host.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using devices::InertialErrors;
using devices::InertialParams;
using sim::Vector3d;

constexpr double dt_s = 0.01;

/// What an InertialErrors needs around it.
class Bench {
 public:
  Bench() : test_(test::box_world("        []\n")) { config_.rate_hz = 1 / dt_s; }
  InertialErrors errors(const InertialParams& params, const std::string& name = "imu") {
    config_.name = name;
    sim::Vehicle& vehicle = *test_.world.vehicles()[0];
    sim::NoiseParams noise;
    noise.key = "gyro_noise";
    return {params, noise, {test_.world, vehicle, config_, vehicle.body("hull"), 0, faults, host_}};
  }
  /// The three axes at rest for some hours.
  std::vector<std::vector<double>> record(const InertialParams& params, double hours) {
    InertialErrors triad = errors(params);
    sim::Random random(1, "record");
    std::vector<std::vector<double>> axes(3);
    const auto count = static_cast<std::int64_t>(hours * 3600 / dt_s);
    for (std::int64_t i = 0; i < count; ++i) {
      random.begin_step(i);
      Vector3d value = Vector3d::Zero();
      triad.apply(value, i == 0 ? 0 : dt_s, random);
      for (int axis = 0; axis < 3; ++axis) axes[static_cast<std::size_t>(axis)].push_back(value[axis]);
    }
    return axes;
  }
  sim::DeviceFaults faults;

 private:
  test::TestWorld test_;
  sim::DeviceConfig config_;
  // A host for devices that use nothing of it.
  sim::ChannelConfig channels_;
  sim::StepClock clock_;
  std::unique_ptr<sim::AcousticChannel> acoustics_;
  sim::EventQueue events_;
  sim::PortOpener open_port_;
  sim::SharedByDevices shared_;
  sim::ArrivalFlags awake_;
  sim::DeviceHost host_{test_.world, channels_,
                        clock_,      0,
                        1,           test_.world.physics(),
                        acoustics_,  events_,
                        open_port_,  test_.world.warnings(),
                        shared_,     awake_};
};

/// The root of the mean square over the axes, and its error: three independent estimates.
sim::AllanPoint pooled(const std::vector<std::vector<double>>& axes, double tau_s) {
  sim::AllanPoint result;
  for (const auto& axis : axes) {
    const sim::AllanPoint point = sim::allan_deviation_at(axis, dt_s, tau_s);
    result.deviation += point.deviation * point.deviation / 3;
    result.relative_error = point.relative_error / std::sqrt(3.0);
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

TEST(InertialErrors, TheAllanDeviationAtOneSecondIsTheAngleRandomWalk) {
  InertialParams params;
  params.random_walk = 0.34 * devices::unit::deg_per_sqrt_h;
  const auto axes = Bench().record(params, 2);
  for (const double tau_s : {0.1, 1.0, 10.0}) {  // slope -1/2: falls as 1 / sqrt(tau)
    const sim::AllanPoint point = pooled(axes, tau_s);
    const double expected = 0.34 / 60 * std::numbers::pi / 180 / std::sqrt(tau_s);
    EXPECT_NEAR(point.deviation, expected, 4 * point.relative_error * expected) << tau_s;
    EXPECT_LT(point.relative_error, 0.03);
  }
}

TEST(InertialErrors, ThePeakOfTheAllanDeviationIsTheBiasInstability) {
  InertialParams params;
  params.bias_instability = 8 * devices::unit::deg_per_h;
  params.bias_time_s = 10;  // short, so that two hours hold many of them
  const auto axes = Bench().record(params, 2);
  // On the whole curve, with the peak at 1.89 correlation times.
  const double sigma = params.bias_instability / devices::gauss_markov_allan_peak;
  for (const double tau_s : {2.0, 18.93, 60.0}) {
    const sim::AllanPoint point = pooled(axes, tau_s);
    const double expected = sigma * devices::gauss_markov_allan_deviation(tau_s / params.bias_time_s);
    EXPECT_NEAR(point.deviation, expected, 4 * point.relative_error * expected) << tau_s;
  }
  EXPECT_NEAR(sigma * devices::gauss_markov_allan_deviation(1.893), params.bias_instability,
              1e-5 * params.bias_instability);
}

TEST(InertialErrors, TheRateRandomWalkRisesWithTheRootOfTime) {
  InertialParams params;
  params.rate_random_walk = 10 * devices::unit::deg_per_h_per_sqrt_h;
  const auto axes = Bench().record(params, 2);
  for (const double tau_s : {3.0, 30.0}) {  // K sqrt(tau / 3), IEEE Std 952-1997
    const sim::AllanPoint point = pooled(axes, tau_s);
    const double expected = params.rate_random_walk * std::sqrt(tau_s / 3);
    EXPECT_NEAR(point.deviation, expected, 4 * point.relative_error * expected) << tau_s;
  }
}

TEST(InertialErrors, ScaleMisalignmentAndTurnOnBiasAreDrawnWithTheirSpread) {
  InertialParams params;
  params.scale = 1e-3;
  params.misalignment_rad = 2e-3;
  params.turn_on_bias = 0.5;
  Bench bench;
  constexpr int units = 500;
  double scale = 0, misalignment = 0, bias = 0;
  for (int i = 0; i < units; ++i) {
    const InertialErrors triad = bench.errors(params, "imu" + std::to_string(i));
    const sim::Matrix3d M = triad.matrix() - sim::Matrix3d::Identity();
    scale += M.diagonal().squaredNorm() / (3 * units);
    misalignment += (M.squaredNorm() - M.diagonal().squaredNorm()) / (6 * units);
    bias += triad.turn_on_bias().squaredNorm() / (3 * units);
  }
  // Four standard deviations of the estimate of a spread from n draws: 4 / sqrt(2 n).
  EXPECT_NEAR(std::sqrt(scale), 1e-3, 1e-3 * 4 / std::sqrt(2.0 * 3 * units));
  EXPECT_NEAR(std::sqrt(misalignment), 2e-3, 2e-3 * 4 / std::sqrt(2.0 * 6 * units));
  EXPECT_NEAR(std::sqrt(bias), 0.5, 0.5 * 4 / std::sqrt(2.0 * 3 * units));
}

TEST(InertialErrors, TheMatrixAndTheBiasActOnTheTruth) {
  InertialParams params;
  params.scale = 0.01;
  params.misalignment_rad = 0.02;
  params.turn_on_bias = 0.1;
  Bench bench;
  InertialErrors triad = bench.errors(params);
  sim::Random random(1, "x");
  Vector3d value(1, 2, 3);
  triad.apply(value, dt_s, random);
  EXPECT_NEAR((value - (triad.matrix() * Vector3d(1, 2, 3) + triad.turn_on_bias())).norm(), 0, 1e-15);
}

TEST(InertialErrors, AChangeKeepsWhatWasDrawn) {
  InertialParams params;
  params.turn_on_bias = 0.1;
  Bench bench;
  InertialErrors triad = bench.errors(params);
  const Vector3d before = triad.turn_on_bias();
  params.turn_on_bias = 0.3;
  triad.change(params, {});
  EXPECT_NEAR((triad.turn_on_bias() - 3 * before).norm(), 0, 1e-15);
}

}  // namespace
