// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/marine/thruster.hpp"

namespace devices {

/// Which command makes a thruster give a thrust: the inverse of its curve.
class ThrusterCommand {
 public:
  explicit ThrusterCommand(const Thruster::Params& params) : params_(params) {}

  /// Limits of the thrust without inflow, N.
  double max_N(double density_kgpm3) const;
  double min_N(double density_kgpm3) const;
  /// In the unit of the thruster's commands, inside its limits.  `inflow_mps`: speed of the water along the axis.
  double command_for_N(double thrust_N, double inflow_mps, double density_kgpm3) const;

 private:
  /// N per level squared, and N lost per level and m/s of inflow.
  struct Bilinear {
    double square, loss;
  };
  Bilinear bilinear(bool ahead, double density_kgpm3) const;
  double thrust_N(double level, double density_kgpm3) const;
  double level_in_table(double thrust_N) const;

  Thruster::Params params_;
};

}  // namespace devices
