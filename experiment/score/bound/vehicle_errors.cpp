// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/vehicle_errors.hpp"

#include <cmath>

#include "devices/comms/acoustic_modem.hpp"
#include "devices/drive/wheel_geometry.hpp"
#include "devices/inertial/ahrs.hpp"
#include "devices/inertial/compass.hpp"
#include "devices/navigation/dvl.hpp"
#include "devices/navigation/gps.hpp"
#include "devices/navigation/odometry.hpp"
#include "devices/navigation/swarm_position.hpp"
#include "devices/sound_positioning/usbl.hpp"
#include "experiment/score/bound/device_params.hpp"

namespace experiment {

namespace {

void read_velocity(const FirstDevice<devices::Dvl>& dvl, double step_s, VehicleErrors& errors) {
  // Four beams 90 degrees apart: the sum of b b^T has 2 sin^2 of the beam angle for each horizontal component.
  const double per_beam = 1 / (std::numbers::sqrt2 * std::sin(dvl.params->beam_angle_rad));
  const double further_mps = errors_of(dvl.params->beam_noise).white_std;
  errors.velocity = errors_of(dvl.params->velocity_noise);
  errors.velocity.white_std = std::hypot(errors.velocity.white_std, per_beam * further_mps);
  errors.beam_std_mps = per_beam * dvl.params->beam_std_mps;
  errors.beam_std_per_mps = per_beam * dvl.params->beam_std_per_mps;
  errors.speed_scale_std = dvl.params->scale_std;
  errors.velocity_period_s = dvl.period_s(step_s);
  errors.sensor_yaw_rad = dvl.device->rpy_rad.z();
}

void read_wheels(const FirstDevice<devices::Odometry>& odometry, const sim::VehicleConfig& vehicle, double step_s,
                 VehicleErrors& errors) {
  const devices::Odometry::Params& params = *odometry.params;
  const std::optional<double> real_radius_m =
      devices::wheel_radius_m_of(vehicle, {params.left_joint, params.right_joint});
  const double real_track_m = devices::track_m_of(vehicle, {params.left_joint}, {params.right_joint});
  const double radius_m = params.wheel_radius_m.value_or(real_radius_m.value_or(0.1));
  const double track_m = params.track_m.value_or(real_track_m);
  if (!(track_m > 0) || !(radius_m > 0)) return;
  errors.motion = VehicleErrors::Motion::wheels;
  // The estimator does not know the errors of calibration: their sizes count as standard deviations.
  const double radius_ratio = real_radius_m ? radius_m / *real_radius_m : 1;
  errors.speed_scale_std = std::abs(radius_ratio - 1);
  errors.turn_scale_std = std::abs(radius_ratio * real_track_m / track_m - 1);
  // Each sample has an independent error of each wheel: forward (l + r) / 2, turn (r - l) / track.
  const double per_wheel_mprts = radius_m * errors_of(params.noise).white_std / std::sqrt(odometry.period_s(step_s));
  errors.along_noise_mprts = per_wheel_mprts / std::numbers::sqrt2;
  errors.turn_noise_radprts = std::numbers::sqrt2 * per_wheel_mprts / track_m;
}

/// Direction in the world needs a heading.
void read_usbl(const FirstDevice<devices::Usbl>& usbl, const QuantityErrors& heading, VehicleErrors& errors) {
  UsblErrors own;
  own.range_std_m = errors_of(usbl.params->range_noise).white_std;
  own.across_std_rad = errors_of(usbl.params->azimuth_noise).white_std;
  own.elevation_std_rad = errors_of(usbl.params->elevation_noise).white_std;
  own.heading_std_rad = heading.white_std;
  if (errors.motion != VehicleErrors::Motion::measured_velocity)
    for (const SlowError& slow : heading.slow) own.heading_std_rad = std::hypot(own.heading_std_rad, slow.initial_std);
  errors.usbl = VehicleErrors::Usbl{{usbl.device->name, usbl.device->position_m}, own};
}

void read_clock(const sim::ClockConfig& clock, VehicleErrors& errors) {
  constexpr double ppm = 1e-6;
  errors.clock_offset_std_s = std::hypot(clock.offset_std_s, clock.offset_s);
  errors.clock_drift_std = ppm * std::hypot(clock.drift_std_ppm, clock.drift_ppm);
  errors.clock_white_fm = clock.white_fm;
  errors.clock_random_walk_fm = clock.random_walk_fm;
  errors.clock_resolution_s = std::max(clock.resolution_s, 1e-6);
}

}  // namespace

QuantityErrors errors_of(const sim::NoiseParams& noise) {
  QuantityErrors errors;
  errors.white_std = std::hypot(noise.gaussian_std, noise.uniform_half_width / std::numbers::sqrt3);
  const double constant = std::hypot(noise.bias_std, noise.bias);
  if (constant > 0 || noise.random_walk_std > 0) errors.slow.push_back({constant, noise.random_walk_std, 0});
  if (noise.gauss_markov_std > 0) errors.slow.push_back({noise.gauss_markov_std, 0, noise.gauss_markov_time_s});
  return errors;
}

VehicleErrors errors_of(const sim::VehicleConfig& vehicle, double step_s) {
  VehicleErrors errors;
  // Motion.
  const FirstDevice<devices::Dvl> dvl(vehicle);
  const FirstDevice<devices::Ahrs> ahrs(vehicle);
  const FirstDevice<devices::Compass> compass(vehicle);
  const FirstDevice<devices::Odometry> odometry(vehicle);
  if (dvl && (ahrs || compass)) {
    errors.motion = VehicleErrors::Motion::measured_velocity;
    errors.heading = errors_of(ahrs ? ahrs.params->heading_noise : compass.params->heading_noise);
    errors.heading_period_s = ahrs ? ahrs.period_s(step_s) : compass.period_s(step_s);
    read_velocity(dvl, step_s, errors);
  } else if (odometry) {
    read_wheels(odometry, vehicle, step_s, errors);
  }
  // Fixes, ranges and relative positions.
  if (const FirstDevice<devices::Gps> gps(vehicle); gps)
    errors.gps = VehicleErrors::Gps{gps.device->name, gps.device->position_m, errors_of(gps.params->horizontal_noise),
                                    errors_of(gps.params->velocity_noise).white_std, gps.params->disciplines_clock};
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (params_as<devices::AcousticModem>(device) != nullptr) errors.modems.push_back({device.name, device.position_m});
  if (const FirstDevice<devices::SwarmPosition> sensor(vehicle); sensor)
    errors.sightings = VehicleErrors::Sightings{{sensor.device->name, sensor.device->position_m},
                                                errors_of(sensor.params->relative_noise).white_std};
  if (const FirstDevice<devices::Usbl> usbl(vehicle); usbl && (ahrs || compass))
    read_usbl(usbl, errors_of(ahrs ? ahrs.params->heading_noise : compass.params->heading_noise), errors);
  read_clock(vehicle.clock, errors);
  return errors;
}

}  // namespace experiment
