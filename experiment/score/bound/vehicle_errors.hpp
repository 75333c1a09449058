// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "experiment/score/bound/usbl_errors.hpp"
#include "sim/base/math.hpp"
#include "sim/random/noise.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace experiment {

/// Slowly changing error of a quantity: constant, a random walk, or Gauss-Markov.
struct SlowError {
  double initial_std = 0;
  double walk_std = 0;  ///< of a random walk, after 1 s
  double time_s = 0;    ///< correlation time of a Gauss-Markov error; 0: none, it does not decay
};

/// Errors of one measured quantity, in its unit.  What NoiseParams calls uniform counts as white noise of the same
/// variance.  Scale errors, outliers, quantization and saturation have no part in it.
struct QuantityErrors {
  double white_std = 0;
  std::vector<SlowError> slow;
};

/// Returns the errors of a quantity.  An estimator does not know a constant `bias`, so its size counts as a standard
/// deviation.
QuantityErrors errors_of(const sim::NoiseParams& noise);

/// Errors of the devices by which a vehicle can localize itself, from its vehicle file.  The first device of a kind
/// counts.
struct VehicleErrors {
  /// Way of dead reckoning.
  enum class Motion {
    unknown,            ///< neither DVL with heading nor odometry: the newest fix, and its speed, is all that is known
    measured_velocity,  ///< velocity by DVL, turned by a heading
    wheels,             ///< odometry of two wheels
  };

  Motion motion = Motion::unknown;

  // Measured velocity.
  QuantityErrors heading;        ///< of AHRS or compass, rad
  double heading_period_s = 0;   ///< of its samples
  QuantityErrors velocity;       ///< of each horizontal component in the axes of the DVL, m/s
  double beam_std_mps = 0;       ///< white error of each horizontal component by the beams
  double beam_std_per_mps = 0;   ///< its increase per m/s of speed
  double velocity_period_s = 0;  ///< of the samples of the DVL
  double speed_scale_std = 0;    ///< relative error of the velocity, or of the distance by the wheels
  double sensor_yaw_rad = 0;     ///< of the DVL in the vehicle

  // Wheels.
  double turn_scale_std = 0;      ///< relative error of turns
  double along_noise_mprts = 0;   ///< white error of the distance, after 1 s
  double turn_noise_radprts = 0;  ///< white error of the heading, after 1 s

  /// Satellite receiver.
  struct Gps {
    std::string device;
    sim::Vector3d antenna_V = sim::Vector3d::Zero();
    QuantityErrors position;      ///< of each horizontal coordinate, m
    double velocity_std_mps = 0;  ///< of each horizontal component
    bool disciplines_clock = false;
  };
  std::optional<Gps> gps;

  /// Device at a point of the vehicle.
  struct Point {
    std::string device;
    sim::Vector3d at_V = sim::Vector3d::Zero();
  };
  std::vector<Point> modems;  ///< acoustic modems

  /// Sensor of the positions of other vehicles.
  struct Sightings {
    Point sensor;
    double white_std_m = 0;  ///< of each coordinate
  };
  std::optional<Sightings> sightings;

  /// USBL of other vehicles.
  struct Usbl {
    Point sensor;
    UsblErrors errors;  ///< including heading errors: all of them in a vehicle without DVL, where they are not states
  };
  std::optional<Usbl> usbl;

  // Clock, which is perfect when all are 0.
  double clock_offset_std_s = 0;
  double clock_drift_std = 0;        ///< a fraction
  double clock_white_fm = 0;         ///< random walk of the error, after 1 s
  double clock_random_walk_fm = 0;   ///< random walk of the frequency, after 1 s
  double clock_resolution_s = 1e-6;  ///< of stamps

  /// Standard deviation of a stamp: it is rounded down to the resolution of the clock, a uniform error.
  double stamp_std_s() const { return clock_resolution_s / std::sqrt(12.0); }

  /// Returns whether the clock is steered by GPS.
  bool disciplined() const { return gps && gps->disciplines_clock; }
  /// Returns whether its position can be bounded.
  bool can_navigate() const { return gps || motion != Motion::unknown; }
};

/// Reads the errors from the devices and the clock of a vehicle, those of a USBL without its array, see usbl_hearing().
/// `step_s`: step of the world, the period of devices that sample in every step.
VehicleErrors errors_of(const sim::VehicleConfig& vehicle, double step_s);

}  // namespace experiment
