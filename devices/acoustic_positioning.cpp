#include "devices/acoustic_positioning.hpp"

namespace devices {

double travel_time_s(const sim::Medium& medium, const sim::Vector3d& from_W, const sim::Vector3d& to_W) {
  constexpr double weights[] = {1, 4, 2, 4, 2, 4, 2, 4, 1};  // of 24
  double slowness_spm = 0;
  for (int i = 0; i < 9; ++i) {
    const sim::Vector3d p_W = from_W + (to_W - from_W) * (i / 8.0);
    slowness_spm += weights[i] / 24 / medium.sound_speed_mps(p_W);
  }
  return slowness_spm * (to_W - from_W).norm();
}

}  // namespace devices
