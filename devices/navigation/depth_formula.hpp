// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"

namespace devices {

/// Conversion of pressure to depth by a sensor; read from the map of the device.
struct DepthFormula {
  double assumed_density_kgpm3 = 1025;
  double assumed_gravity_mps2 = 9.80665;
  double assumed_surface_Pa = 101325;
  void read(sim::ParamReader& in);
  /// Returns (p - surface pressure) / (density gravity), m; `pressure_Pa` is absolute.
  double depth_m(double pressure_Pa) const {
    return (pressure_Pa - assumed_surface_Pa) / (assumed_density_kgpm3 * assumed_gravity_mps2);
  }
};

}  // namespace devices
