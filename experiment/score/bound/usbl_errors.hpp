// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "devices/sound_positioning/usbl_array.hpp"
#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/medium/medium.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace experiment {

/// Answers as a USBL with an `array:` receives them: the sonar equation along a straight line, without echoes, fading,
/// shadows and other sounds.
struct UsblHearing {
  devices::UsblArrayParams array;
  devices::UsblTone tone;          ///< its `snr`: without the loss
  sim::SpreadingConfig spreading;  ///< of the loss
  double absorption_dBpkm = 0;     ///< of the loss
  double cosine_std(double range_m) const;
};

/// White errors of the USBL of a vehicle, whose array is taken to lie level.
struct UsblErrors {
  double range_std_m = 0;
  double across_std_rad = 0;     ///< of the direction
  double elevation_std_rad = 0;  ///< of the direction
  double heading_std_rad = 0;    ///< of the heading of the vehicle, without the part that is a state
  std::optional<UsblHearing> hearing;

  /// Variances of a measured horizontal displacement: along it and across it.
  struct Plane {
    double along_m2, across_m2;
  };
  /// `displacement_m`: of the target, z upwards.
  Plane at(const sim::Vector3d& displacement_m) const;
};

/// Returns what the first USBL of a vehicle receives of the first transponder of its network on `vehicles`; nothing
/// without an `array:` or a transponder.
std::optional<UsblHearing> usbl_hearing(const sim::VehicleConfig& own,
                                        const std::vector<const sim::VehicleConfig*>& vehicles,
                                        const sim::AcousticsConfig& acoustics, const sim::Medium& medium);

}  // namespace experiment
