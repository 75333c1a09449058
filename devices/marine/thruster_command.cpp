// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/thruster_command.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace devices {

ThrusterCommand::Bilinear ThrusterCommand::bilinear(bool ahead, double density_kgpm3) const {
  const double kept = 1 - params_.thrust_deduction;
  if (params_.curve == Thruster::Curve::quadratic)
    return {kept * (ahead ? params_.ahead : params_.astern.value_or(params_.ahead)), kept * params_.inflow_loss};
  // kt_kq: turns per second for a level of one.
  double turns = params_.full_speed_rpm.value_or(0) / 60;
  if (params_.command == Thruster::Command::rpm) turns = 1.0 / 60;
  if (params_.command == Thruster::Command::radps) turns = 0.5 / std::numbers::pi;
  const double D = params_.diameter_m;
  const double scale = kept * params_.density_kgpm3.value_or(density_kgpm3) * D * D * D;
  return {scale * D * params_.k_t0 * turns * turns, ahead ? scale * params_.k_t_slope * turns : 0};
}

double ThrusterCommand::thrust_N(double level, double density_kgpm3) const {
  // The hull takes back a share of the thrust, since the propeller lowers the pressure at the stern.
  if (params_.curve == Thruster::Curve::direct) return (1 - params_.thrust_deduction) * level;
  if (params_.curve == Thruster::Curve::table) {
    const std::vector<double>& table = params_.table;
    if (level <= table[0]) return (1 - params_.thrust_deduction) * table[1];
    for (std::size_t i = 2; i < table.size(); i += 2)
      if (level <= table[i]) {
        const double share = (level - table[i - 2]) / (table[i] - table[i - 2]);
        return (1 - params_.thrust_deduction) * (table[i - 1] + share * (table[i + 1] - table[i - 1]));
      }
    return (1 - params_.thrust_deduction) * table.back();
  }
  return bilinear(level >= 0, density_kgpm3).square * level * std::abs(level);
}

double ThrusterCommand::max_N(double density_kgpm3) const {
  return thrust_N(params_.upper(), density_kgpm3);
}

double ThrusterCommand::min_N(double density_kgpm3) const {
  return thrust_N(params_.lower(), density_kgpm3);
}

/// Returns the level closest to zero with this thrust; flat parts of the table are skipped as dead bands.
double ThrusterCommand::level_in_table(double thrust_N) const {
  if (thrust_N == 0) return 0;
  const std::vector<double>& table = params_.table;
  double best = thrust_N > 0 ? table[table.size() - 2] : table[0];
  for (std::size_t i = 2; i < table.size(); i += 2) {
    const double low = table[i - 1], high = table[i + 1];
    if (low == high || (thrust_N - low) * (thrust_N - high) > 0) continue;
    const double level = table[i - 2] + (thrust_N - low) / (high - low) * (table[i] - table[i - 2]);
    if (std::abs(level) < std::abs(best)) best = level;
  }
  return best;
}

double ThrusterCommand::force_N(double level, double inflow_mps, double density_kgpm3) const {
  const double still_N = thrust_N(level, density_kgpm3);
  if (params_.curve == Thruster::Curve::direct || params_.curve == Thruster::Curve::table) return still_N;
  const double against_mps = (1 - params_.wake_fraction) * std::max(0.0, level > 0 ? inflow_mps : -inflow_mps);
  return still_N - bilinear(level >= 0, density_kgpm3).loss * level * against_mps;
}

double ThrusterCommand::command_for_N(double thrust_N, double inflow_mps, double density_kgpm3) const {
  double level = 0;
  if (params_.curve == Thruster::Curve::direct) {
    level = thrust_N / (1 - params_.thrust_deduction);
  } else if (params_.curve == Thruster::Curve::table) {
    level = level_in_table(thrust_N / (1 - params_.thrust_deduction));
  } else if (thrust_N != 0) {
    // Solve |thrust| = square level^2 - loss level inflow for the level, both positive in the direction of the thrust.
    const bool ahead = thrust_N > 0;
    const Bilinear curve = bilinear(ahead, density_kgpm3);
    const double inflow = (1 - params_.wake_fraction) * (ahead ? inflow_mps : -inflow_mps);
    if (curve.square > 0) {
      const double half = curve.loss * std::max(0.0, inflow) / (2 * curve.square);
      level = half + std::sqrt(half * half + std::abs(thrust_N) / curve.square);
    }
    if (!ahead) level = -level;
  }
  return std::clamp(level, params_.lower(), params_.upper());
}

}  // namespace devices
