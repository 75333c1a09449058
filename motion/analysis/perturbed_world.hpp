// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/world_file/world_config.hpp"

namespace motion {

/// How a world differs from its file.
struct Perturbation {
  std::optional<double> friction;  ///< of the contacts of the vehicle; unset: as in the file
  double mass = 1;                 ///< factor of the masses of the vehicle
  double effort = 1;               ///< factor of the maximum efforts of its servos
  double lag_s = 0;                ///< by which the time constant 1/kp of its servos is longer
  double ground_m = 0;             ///< bumps of the ground, up and down
  bool half_step = false;
  std::int64_t ground_seed = 1;
};

/// Ranges of perturbations.
struct PerturbationRanges {
  double friction_low = 0.4, friction_high = 1.0;
  double mass = 0.1;  ///< above and below 1
  double effort_low = 0.6, effort_high = 1.2;
  double lag_s = 0.016;
  double ground_m = 0.003;
};

/// Draws perturbations: each quantity is spread evenly over its range (Latin hypercube).  The ground is even in every
/// second one, and the step is half in every fourth one.
std::vector<Perturbation> drawn_perturbations(int count, std::uint64_t seed, const std::string& stream,
                                              const PerturbationRanges& ranges = {});

/// Returns the friction of the contacts of a vehicle, that drawn or set perturbations replace: of its first contact,
/// else of the first of the world, else the default.
double friction_of(const sim::WorldConfig& world, const std::string& vehicle);

/// Returns the name of the only vehicle with a motion_player, or checks that `vehicle` has one.  Throws ConfigError.
std::string walking_vehicle(const sim::WorldConfig& world, const std::string& vehicle);

/// Returns the world with only what a walk needs: its objects and the vehicles, those with no devices but servos,
/// groups and players.  Without events, metrics, rules and programs.
sim::WorldConfig world_for_walks(const sim::WorldConfig& world);

/// Returns the world as perturbed.  Bumps replace a plane of a fixed object, over 8 m about the vehicle.
sim::WorldConfig perturbed(sim::WorldConfig world, const std::string& vehicle, const Perturbation& perturbation);

/// Makes the vehicle play a motion from the start of the run, without end.
void set_played_motion(sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& motion);

}  // namespace motion
