// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Errors of a triad of gyros or accelerometers as stated in data sheets (terms of IEEE Std 952-1997), in SI units:
/// rad/s of a gyro, m/s^2 of an accelerometer, written [u] here.
struct InertialParams {
  double random_walk = 0;       ///< white noise: angle or velocity random walk, [u] sqrt(s)
  double bias_instability = 0;  ///< peak of the Allan deviation of the slow error, [u]
  double bias_time_s = 100;     ///< correlation time of the slow error
  double rate_random_walk = 0;  ///< standard deviation of the drift after one second, [u] / sqrt(s)
  double turn_on_bias = 0;      ///< standard deviation of an offset drawn once, [u]
  double scale = 0;             ///< standard deviation of the scale error of each axis, drawn once
  double misalignment_rad = 0;  ///< standard deviation of each cross-axis element, drawn once
  double range = 0;             ///< output limit +-, [u]; 0: unlimited
  double resolution = 0;        ///< quantization step of the output, [u]; 0: none
};

/// Conversion factors from data sheet units to SI units.
namespace unit {
inline constexpr double mps2_per_g = 9.80665;  ///< standard gravity, independent of the gravity of the world
inline constexpr double degps = sim::degrees_to_radians(1);
inline constexpr double deg_per_h = degps / 3600;
inline constexpr double deg_per_sqrt_h = degps / 60;  ///< angle random walk, in rad / sqrt(s)
inline constexpr double deg_per_h_per_sqrt_h = degps / 3600 / 60;
inline constexpr double mps_per_sqrt_h = 1.0 / 60;  ///< velocity random walk, in m / s / sqrt(s)
inline constexpr double mg = 1e-3 * mps2_per_g;
inline constexpr double ug = 1e-6 * mps2_per_g;
inline constexpr double ug_per_sqrt_h = ug / 60;
inline constexpr double ppm = 1e-6;
inline constexpr double mrad = 1e-3;
}  // namespace unit

/// Allan deviation of a first-order Gauss-Markov process of standard deviation 1 over correlation times `tau / T_c`:
/// sigma_A^2 = 2 / x (1 - (3 - 4 exp(-x) + exp(-2 x)) / (2 x)).  Derived from the definition of the Allan variance with
/// the covariance exp(-|t| / T_c).
double gauss_markov_allan_deviation(double correlation_times);

/// Maximum of that Allan deviation, at tau = 1.89 T_c (found numerically from the formula above).  Data sheets quote
/// the flat part of the measured Allan deviation as `bias instability`; the standard deviation of the Gauss-Markov
/// process is chosen so that its peak has that value: sigma = quoted / 0.6174.
inline constexpr double gauss_markov_allan_peak = 0.61737;
inline constexpr double gauss_markov_allan_peak_at = 1.8926;  ///< correlation times

/// Error model of a triad: output = (I + M) truth + offset + drift + white noise, limited and quantized.  The diagonal
/// of M holds scale errors, the other elements misalignments of the axes (first order; Titterton and Weston, Strapdown
/// Inertial Navigation Technology, 2nd ed., 2004).
class InertialErrors {
 public:
  /// Faults of the quantity of `noise` also affect the errors of the data sheet.
  InertialErrors(const InertialParams& params, const sim::NoiseParams& noise, const sim::DeviceContext& context);
  /// Applies changed parameters.  Errors that were drawn once keep their direction and are rescaled.
  void change(const InertialParams& params, const sim::NoiseParams& noise);
  void apply(sim::Vector3d& value, double dt_s, sim::Random& random);
  void visit_state(sim::StateArchive& archive) { archive(noise_, started_, gauss_markov_, walk_); }

  const sim::Matrix3d& matrix() const { return matrix_; }  ///< I + M
  const sim::Vector3d& turn_on_bias() const { return turn_on_bias_; }

 private:
  void use(const InertialParams& params);
  void plan(double dt_s);
  void add_random_parts(sim::Vector3d& value, sim::Random& random);

  InertialParams params_;
  sim::Noise noise_;
  const sim::NoiseFault& fault_;
  double nominal_dt_s_;  ///< interval used before the first sample
  // Drawn once, standard normal.
  sim::Vector3d drawn_bias_;
  sim::Matrix3d drawn_matrix_;
  sim::Matrix3d matrix_ = sim::Matrix3d::Identity();
  sim::Vector3d turn_on_bias_ = sim::Vector3d::Zero();
  // Values for the interval cached_dt_s_.
  double cached_dt_s_ = -1;
  double white_std_ = 0, kept_ = 0, fresh_std_ = 0, walk_std_ = 0;
  bool started_ = false;
  sim::Vector3d gauss_markov_ = sim::Vector3d::Zero();
  sim::Vector3d walk_ = sim::Vector3d::Zero();
};

}  // namespace devices
