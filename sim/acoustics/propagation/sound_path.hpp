// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/math.hpp"
#include "sim/medium/medium.hpp"

namespace sim {

/// Travel time of sound along the straight line between two points, s: its length times the mean of 1 / c over the
/// depths, below the still surface.  Above the surface the water properties at the surface are used.
double travel_time_s(const Medium& medium, const Vector3d& from_W, const Vector3d& to_W);

/// Arrival of a sound at a moving receiver.
struct Arrival {
  double travel_time_s = 0;
  Vector3d p_W = Vector3d::Zero();           ///< of the receiver at that time
  Vector3d direction_W = Vector3d::UnitX();  ///< unit vector from the source to p_W
  double range_m = 0;                        ///< from the position of the source at transmission
};

/// Computes time and place at which a sound from `source_W` meets a receiver that is at `receiver_W` at transmission
/// and moves at constant `velocity_W`, to 1e-9 s.  Empty when the receiver is as fast as the sound.
std::optional<Arrival> meeting(const Medium& medium, const Vector3d& source_W, const Vector3d& receiver_W,
                               const Vector3d& velocity_W);
/// The same for a receiver whose position `receiver_W` is known at another time, `seen_at`.
std::optional<Arrival> meeting(const Medium& medium, const Vector3d& source_W, Time sent_at, const Vector3d& receiver_W,
                               Time seen_at, const Vector3d& velocity_W);

/// Closing speed of source and receiver, m/s: component along the unit vector between them of the source velocity at
/// transmission minus the receiver velocity at reception.
double closing_speed_mps(const Vector3d& direction_W, const Vector3d& source_velocity_W,
                         const Vector3d& receiver_velocity_W);
/// Ratio of received to transmitted frequency: (c - v_r) / (c - v_s), with the velocity components along the direction.
double doppler_factor(const Vector3d& direction_W, const Vector3d& source_velocity_W,
                      const Vector3d& receiver_velocity_W, double sound_speed_mps);

}  // namespace sim
