#pragma once

#include <optional>

#include "sim/config/param_reader.hpp"
#include "sim/math.hpp"

namespace sim {

/// `water:` of a medium.
struct WaterConfig {
  double surface_m = 0;         ///< height of the still surface in the world
  double density_kgpm3 = 1025;  ///< sea water
  double temperature_C = 10;
  double salinity_psu = 35;
  void read(ParamReader& in);
};

/// `current:` of a medium.
struct CurrentConfig {
  Vector3d velocity_mps = Vector3d::Zero();  ///< east, north, up
  void read(ParamReader& in);
};

/// `medium:` of a world.
struct MediumConfig {
  std::optional<WaterConfig> water;  ///< unset: the world is dry
  CurrentConfig current;
  void read(ParamReader& in);
};

}  // namespace sim
