// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/math.hpp"
#include "sim/medium/medium.hpp"

namespace sim {

/// Time that sound takes along the straight line between two places, s: its length by the mean of 1 / c on it, by depth
/// below the still surface.  What is over the surface counts as water at the surface.
double travel_time_s(const Medium& medium, const Vector3d& from_W, const Vector3d& to_W);

/// Where a sound meets a receiver on its way.
struct Arrival {
  double travel_time_s = 0;
  Vector3d p_W = Vector3d::Zero();           ///< of the receiver at that time
  Vector3d direction_W = Vector3d::UnitX();  ///< unit, from the source to there
  double range_m = 0;                        ///< from where the source was
};

/// A sound starts at `source_W`, when a receiver is at `receiver_W` and continues at `velocity_W`: when and where they
/// meet, to 1e-9 s.  Nothing when the receiver is as fast as the sound.
std::optional<Arrival> meeting(const Medium& medium, const Vector3d& source_W, const Vector3d& receiver_W,
                               const Vector3d& velocity_W);
/// The same for a receiver that was seen at another time: it is at `receiver_W` at `seen_at`.
std::optional<Arrival> meeting(const Medium& medium, const Vector3d& source_W, Time sent_at, const Vector3d& receiver_W,
                               Time seen_at, const Vector3d& velocity_W);

/// Closing speed of the ends, m/s: the source's velocity at transmission, the receiver's at reception, along the unit
/// vector between them.
double closing_speed_mps(const Vector3d& direction_W, const Vector3d& source_velocity_W,
                         const Vector3d& receiver_velocity_W);
/// Received frequency over sent: (c - v_r) / (c - v_s), each along the direction.
double doppler_factor(const Vector3d& direction_W, const Vector3d& source_velocity_W,
                      const Vector3d& receiver_velocity_W, double sound_speed_mps);

}  // namespace sim
