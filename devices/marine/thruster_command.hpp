// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/marine/thruster.hpp"

namespace devices {

/// Inverse of a thrust curve: from thrust to command.
class ThrusterCommand {
 public:
  explicit ThrusterCommand(const Thruster::Params& params) : params_(params) {}

  /// Return the limits of the thrust without inflow, N.
  double max_N(double density_kgpm3) const;
  double min_N(double density_kgpm3) const;
  /// Returns the thrust of a command within the limits.
  double force_N(double level, double inflow_mps, double density_kgpm3) const;
  /// Returns the command for a thrust, in the unit of the thruster's commands and within its limits.  `inflow_mps`:
  /// inflow speed along the axis.
  double command_for_N(double thrust_N, double inflow_mps, double density_kgpm3) const;

 private:
  /// Coefficients of the bilinear model: N per level squared, and N lost per level and m/s of inflow.
  struct Bilinear {
    double square, loss;
  };
  Bilinear bilinear(bool ahead, double density_kgpm3) const;
  double thrust_N(double level, double density_kgpm3) const;
  double level_in_table(double thrust_N) const;

  Thruster::Params params_;
};

}  // namespace devices
