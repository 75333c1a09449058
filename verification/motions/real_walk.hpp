// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "motion/analysis/walk.hpp"
#include "motion/gait/skelliptical.hpp"
#include "sim/world_file/world_config.hpp"

namespace verification {

/// Walk of a real robot, measured.
struct RealWalk {
  motion::GaitStep step;   ///< commanded, of half a period
  double measured = 0;     ///< speed, m/s; of a turn rad/s
  bool is_fitted = false;  ///< parameters of the model may be fitted to it
};

/// The walk "Fast Forward" of rUNSWift on ERS-7 dogs in 2005, straight: nine strides (rUNSWift, walkBase/data,
/// 1000/rawFFForward.dat).
std::vector<RealWalk> fast_forward_strides();
/// The same walk, turning in place: seven turns counter-clockwise (5458/rawFFForwardTurnCCW.dat).
std::vector<RealWalk> fast_forward_turns();

/// Parameters of a model of the dog.  Unset: as in the vehicle file.
struct DogParameters {
  std::optional<double> friction;      ///< of the paws
  std::optional<double> effort_Nm;     ///< greatest torque of the leg servos
  std::optional<double> gain_per_s;    ///< of the leg servos
  std::optional<double> speed_factor;  ///< factor of the maximum velocities of the leg servos
  std::optional<double> play_rad;      ///< of the gears of the leg servos
  std::optional<double> flap_factor;   ///< gain of the flaps over that of swings and knees
};

/// Returns the world with the parameters of one of its vehicles.
sim::WorldConfig with_parameters(sim::WorldConfig world, const std::string& vehicle, const DogParameters& parameters);

/// Returns the simulated speeds of walks, m/s or rad/s; 0 of one that falls.  Commands are limited to the ranges of the
/// joints only, as on the dog.
std::vector<double> simulated_speeds(const sim::WorldConfig& world, const std::string& vehicle,
                                     std::span<const RealWalk> walks, const motion::WalkOptions& options, int threads);

/// Returns the root of the mean squared relative error of simulated speeds.  `only_fitted`: of the fitted walks.
double relative_rms(std::span<const RealWalk> walks, std::span<const double> simulated, bool only_fitted);

}  // namespace verification
