#include "sim/medium/medium_config.hpp"

namespace sim {

void WaterConfig::read(ParamReader& in) {
  in.read("surface_m", surface_m, between(-1e6, 1e6), "height of the still surface in the world");
  in.read("density_kgpm3", density_kgpm3, between(1, 20000), "of the water; sea 1025, fresh 1000");
  in.read("temperature_C", temperature_C, between(-5, 100), "of the water");
  in.read("salinity_psu", salinity_psu, between(0, 400), "of the water");
}

void CurrentConfig::read(ParamReader& in) {
  in.read("velocity_mps", velocity_mps, between(-100, 100), "east, north, up");
}

void MediumConfig::read(ParamReader& in) {
  in.read("water", water, "the sea, a lake or a tank; absent: the world is dry");
  in.read("current", current, "how the water moves");
}

}  // namespace sim
