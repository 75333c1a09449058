// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/sound_path.hpp"

#include <cmath>

namespace sim {

double travel_time_s(const Medium& medium, const Vector3d& from_W, const Vector3d& to_W) {
  return (to_W - from_W).norm() * medium.mean_slowness_spm(from_W.z(), to_W.z());
}

namespace {

/// Smallest t >= 0 with |offset + velocity t| = c t.
std::optional<double> same_speed_meeting_s(const Vector3d& offset_W, const Vector3d& velocity_W, double c_mps) {
  const double a = c_mps * c_mps - velocity_W.squaredNorm(), b = offset_W.dot(velocity_W);
  if (a <= 0) return std::nullopt;
  return (b + std::sqrt(b * b + a * offset_W.squaredNorm())) / a;
}

}  // namespace

std::optional<Arrival> meeting(const Medium& medium, const Vector3d& source_W, const Vector3d& receiver_W,
                               const Vector3d& velocity_W) {
  const Vector3d offset_W = receiver_W - source_W;
  Vector3d p_W = receiver_W;
  double t_s = 0;
  // Fixed-point iteration: the slowness varies little between iterates, and each one gains at least 5 digits.
  for (int round = 0; round < 20; ++round) {
    const double c_mps = 1 / medium.mean_slowness_spm(source_W.z(), p_W.z());
    const std::optional<double> next_s = same_speed_meeting_s(offset_W, velocity_W, c_mps);
    if (!next_s) return std::nullopt;
    const bool done = std::abs(*next_s - t_s) < 1e-11;
    t_s = *next_s;
    p_W = receiver_W + velocity_W * t_s;
    if (done) break;
  }
  const Vector3d displacement_W = p_W - source_W;
  const double range_m = displacement_W.norm();
  return Arrival{t_s, p_W, range_m > 0 ? Vector3d(displacement_W / range_m) : Vector3d::UnitX(), range_m};
}

std::optional<Arrival> meeting(const Medium& medium, const Vector3d& source_W, Time sent_at, const Vector3d& receiver_W,
                               Time seen_at, const Vector3d& velocity_W) {
  return meeting(medium, source_W, receiver_W + velocity_W * to_seconds(sent_at - seen_at), velocity_W);
}

double closing_speed_mps(const Vector3d& direction_W, const Vector3d& source_velocity_W,
                         const Vector3d& receiver_velocity_W) {
  return direction_W.dot(source_velocity_W - receiver_velocity_W);
}

double doppler_factor(const Vector3d& direction_W, const Vector3d& source_velocity_W,
                      const Vector3d& receiver_velocity_W, double sound_speed_mps) {
  return (sound_speed_mps - direction_W.dot(receiver_velocity_W)) /
         (sound_speed_mps - direction_W.dot(source_velocity_W));
}

}  // namespace sim
