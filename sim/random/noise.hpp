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

/// The error of one measured quantity, in the unit of that quantity.  The parts compose in this order:
/// scale error, constant bias, random walk, Gauss-Markov, gaussian, uniform, outliers, quantisation, saturation.
/// YAML: a map with any of these keys; all are off by default.
struct NoiseParams {
  double scale_error = 0;            ///< measured = truth * (1 + scale_error)
  double bias = 0;                   ///< constant offset
  double bias_std = 0;               ///< a constant offset drawn once per run
  double random_walk_std = 0;        ///< of the drift after one second (grows with the square root of time)
  double gauss_markov_std = 0;       ///< stationary standard deviation of a first order Gauss-Markov error
  double gauss_markov_time_s = 100;  ///< its correlation time
  double gaussian_std = 0;           ///< white
  double uniform_half_width = 0;     ///< white, uniform in +- this
  double outlier_probability = 0;    ///< that a value gets an outlier
  double outlier_std = 0;            ///< standard deviation of an outlier
  double quantization = 0;           ///< step of the output; 0: none
  std::optional<double> saturation;  ///< the output is cut to +- this
  const char* key = "";              ///< that it was read by, such as `gyro_noise`: its quantity is named after it

  /// Reads the keys.
  void read(ParamReader& in);
  /// Called by ParamReader with the key that holds these parameters.
  void set_key(const char* read_by) { key = read_by; }
  /// Whether any error is on.
  bool any() const;
};

/// What a fault does to the error of a quantity; the random draws stay the same, so that a fault which is cleared
/// leaves no trace.
struct NoiseFault {
  double bias = 0;    ///< added
  double factor = 1;  ///< of the random parts: random walk, Gauss-Markov, gaussian, uniform, outliers
};

/// Where the errors of one quantity of a device come from: the random stream and the faults.
struct NoiseOrigin {
  std::uint64_t seed;       ///< of the world
  std::string stream;       ///< its name, such as `rover1/imu#gyro`
  const NoiseFault* fault;  ///< outlives the device
};

/// The state of the error of a few values of one quantity (one for a range scanner's beams: only white parts differ
/// by value; one per axis for a vector).  The slow parts (bias, random walk, Gauss-Markov) are one per value.
class Noise {
 public:
  /// `values`: how many values have their own slow state.  `fault` must outlive the noise; null: it has none.
  /// Devices have NoiseOf.
  Noise(const NoiseParams& params, int values, Random bias_source, const NoiseFault* fault = nullptr);

  /// Disturbs `values` in place.  values.size() may be larger than the number of slow states: value i then uses
  /// state i % states.  `dt_s`: time since the last call (exact discretisation of the slow parts); 0 at the first.
  void apply(std::span<double> values, double dt_s, Random& random);
  /// Disturbs one value in place.
  void apply(double& value, double dt_s, Random& random);
  /// Changes the parameters; drawn biases and accumulated drifts are kept.
  void change(const NoiseParams& params);

  /// The slow errors.
  void visit_state(StateArchive& archive) {
    archive(started_);
    archive.expect_count(slow_.size(), "slow errors of a quantity");
    for (Slow& slow : slow_) {
      // The constant part is not a state, so that another one holds when a snapshot is restored.
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
    double drawn = 0;  ///< of the bias, once
    double bias = 0;   ///< constant and drawn
    double walk = 0;
    double gauss_markov = 0;
  };
  /// Computes what advance() needs for `dt_s`.
  void plan(double dt_s);
  /// Takes the slow parts over `dt_s`.
  void advance(double dt_s, Random& random);

  NoiseParams params_;
  const NoiseFault* fault_;
  std::vector<Slow> slow_;
  bool started_ = false;
  double planned_dt_s_ = -1;
  double walk_root_s_ = 0, kept_ = 0, fresh_std_ = 0;
};

/// The error of a device's quantity, described by `member` of its Params: `NoiseOf<&Params::range_noise>`.  The key
/// that `member` was read by names its random stream and its faults.
template <auto member>
class NoiseOf : public Noise {
 public:
  /// `context`: a DeviceContext; `values` as in Noise.
  template <typename Context, typename Params>
  NoiseOf(const Context& context, const Params& params, int values = 1)
      : Noise(context.noise(params.*member, values)) {}

  /// Takes other parameters; see Noise::change().
  template <typename Params>
  void change(const Params& params) {
    Noise::change(params.*member);
  }
};

/// The same for a quantity that has errors of their own for each of several targets, which are removed and added.
template <auto member>
class NoisesOf {
 public:
  /// `context`: a DeviceContext.
  template <typename Context, typename Params>
  NoisesOf(const Context& context, const Params& params) : origin_(context.noise_origin(params.*member)) {}

  /// The errors to `target`.
  template <typename Params>
  Noise to(const std::string& target, const Params& params, int values = 1) const {
    return {params.*member, values, Random(origin_.seed, origin_.stream + "/" + target), origin_.fault};
  }

 private:
  NoiseOrigin origin_;
};

}  // namespace sim
