// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Error model of one measured quantity, in its unit.  The parts are applied in this order: scale error, constant bias,
/// random walk, Gauss-Markov, gaussian, uniform, outliers, quantization, saturation.  YAML: a map with any of these
/// keys; all are off by default.
struct NoiseParams {
  double scale_error = 0;            ///< measured = truth * (1 + scale_error)
  double bias = 0;                   ///< constant offset
  double bias_std = 0;               ///< a constant offset drawn once per run
  double random_walk_std = 0;        ///< of the drift after 1 s (grows with the square root of time)
  double gauss_markov_std = 0;       ///< stationary standard deviation of a first order Gauss-Markov error
  double gauss_markov_time_s = 100;  ///< its correlation time
  double gaussian_std = 0;           ///< white
  double uniform_half_width = 0;     ///< white, uniform between - and + this
  double outlier_probability = 0;    ///< probability of an outlier for each value
  double outlier_std = 0;            ///< standard deviation of an outlier
  double quantization = 0;           ///< step of the output; 0: none
  std::optional<double> saturation;  ///< the output is limited to +- this
  const char* key = "";              ///< key that it was read from, such as `gyro_noise`; names its quantity

  /// Reads the keys.
  void read(ParamReader& in);
  /// Called by ParamReader with the key that holds these parameters.
  void set_key(const char* read_by) { key = read_by; }
  /// Whether any error is on.
  bool any() const;
};

/// Effect of a fault on the error of a quantity; the random draws do not change, so that a cleared fault has no later
/// effect.
struct NoiseFault {
  double bias = 0;    ///< added
  double factor = 1;  ///< of the random parts: random walk, Gauss-Markov, gaussian, uniform, outliers
};

/// Source of the errors of one quantity of a device: random stream and faults.
struct NoiseOrigin {
  std::uint64_t seed;       ///< of the world
  std::string stream;       ///< its name, such as `rover1/imu#gyro`
  const NoiseFault* fault;  ///< outlives the device
};

/// Error state of a few values of one quantity (one for the beams of a range scanner, which differ only in the white
/// parts; one per axis for a vector).  Each has its own slow errors (bias, random walk, Gauss-Markov).
class Noise {
 public:
  /// Makes the error state.  `values`: number of slow states.  `fault` must outlive the noise; null: none.  Devices use
  /// NoiseOf.
  Noise(const NoiseParams& params, int values, Random bias_source, const NoiseFault* fault = nullptr);

  /// Adds errors to `values` in place.  values.size() may be larger than the number of slow states: value i then uses
  /// state i % states.  `dt_s`: time since the last call (exact discretization of the slow parts); 0 at the first.
  void apply(std::span<double> values, double dt_s, Random& random);
  /// Adds errors to one value in place.
  void apply(double& value, double dt_s, Random& random);
  /// Changes the parameters; drawn biases and accumulated drifts are kept.
  void change(const NoiseParams& params);

  /// Visits the slow errors.
  void visit_state(StateArchive& archive) {
    archive(started_);
    archive.expect_count(slow_.size(), "slow errors of a quantity");
    for (Slow& slow : slow_) {
      // The constant bias is a parameter, not a state: a snapshot can be restored with another one.
      if (archive.hashing())
        archive(slow.bias);
      else
        archive(slow.drawn);
      archive(slow.walk, slow.gauss_markov);
      if (archive.restoring()) slow.bias = params_.bias + slow.drawn;
    }
  }

 private:
  struct Slow {
    double drawn = 0;  ///< part of the bias drawn once
    double bias = 0;   ///< constant and drawn
    double walk = 0;
    double gauss_markov = 0;
  };
  /// Computes the coefficients of advance() for `dt_s`.
  void plan(double dt_s);
  /// Advances the slow parts by `dt_s`.
  void advance(double dt_s, Random& random);

  NoiseParams params_;
  const NoiseFault* fault_;
  std::vector<Slow> slow_;
  bool started_ = false;
  double planned_dt_s_ = -1;
  double walk_root_s_ = 0, kept_ = 0, fresh_std_ = 0;
};

/// Error of a device's quantity, described by `member` of its Params: `NoiseOf<&Params::range_noise>`.  The key of
/// `member` names its random stream and its faults.
template <auto member>
class NoiseOf : public Noise {
 public:
  /// `context`: a DeviceContext; `values` as in Noise.
  template <typename Context, typename Params>
  NoiseOf(const Context& context, const Params& params, int values = 1)
      : Noise(context.noise(params.*member, values)) {}

  /// Changes the parameters; see Noise::change().
  template <typename Params>
  void change(const Params& params) {
    Noise::change(params.*member);
  }
};

/// The same for a quantity with separate errors for each of several targets, which can be added and removed.
template <auto member>
class NoisesOf {
 public:
  /// `context`: a DeviceContext.
  template <typename Context, typename Params>
  NoisesOf(const Context& context, const Params& params) : origin_(context.noise_origin(params.*member)) {}

  /// Makes the error state for `target`.
  template <typename Params>
  Noise to(const std::string& target, const Params& params, int values = 1) const {
    return {params.*member, values, Random(origin_.seed, origin_.stream + "/" + target), origin_.fault};
  }

 private:
  NoiseOrigin origin_;
};

}  // namespace sim
