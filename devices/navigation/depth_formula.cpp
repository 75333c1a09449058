// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/depth_formula.hpp"

namespace devices {

void DepthFormula::read(sim::ParamReader& in) {
  in.read("assumed_density_kgpm3", assumed_density_kgpm3, sim::between(500, 2000),
          "density that the sensor assumes when it converts pressure to depth");
  in.read("assumed_gravity_mps2", assumed_gravity_mps2, sim::between(0.1, 100), "gravity that the sensor assumes");
  in.read("assumed_surface_Pa", assumed_surface_Pa, sim::between(0, 1e7),
          "absolute pressure that it assumes at depth 0");
}

}  // namespace devices
