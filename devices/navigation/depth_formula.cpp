// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/depth_formula.hpp"

namespace devices {

void DepthFormula::read(sim::ParamReader& in) {
  in.read("assumed_density_kgpm3", assumed_density_kgpm3, sim::between(500, 2000),
          "of the water, as the sensor believes when it makes a depth of a pressure");
  in.read("assumed_gravity_mps2", assumed_gravity_mps2, sim::between(0.1, 100), "as the sensor believes");
  in.read("assumed_surface_Pa", assumed_surface_Pa, sim::between(0, 1e7),
          "absolute pressure that it takes for depth 0");
}

}  // namespace devices
