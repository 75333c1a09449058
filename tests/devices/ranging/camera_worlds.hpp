// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string>

#include "shoal/image_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace camera_worlds {

/// A camera in the middle of the rover, 0.5 m above the ground, looking ahead.
inline std::string camera(const std::string& more = "") {
  return "        - {name: camera, type: camera, position_m: [0, 0, 0.4]" + more + "}\n";
}

inline const char* wall_ahead =
    "  - {name: wall, fixed: true, position_m: [3.1, 0, 2], parts: [{shape: box, size_m: [0.2, 20, 20]}]}\n";
inline const char* small = ", width: 64, height: 48, rate_hz: 10";

inline shoal::image_t image_of(const std::string& keys, const std::string& objects = "", double run_s = 0.2) {
  test::TestWorld test(test::rover_world(camera(keys), objects));
  test::Listener<shoal::image_t> images(test, "r1.camera");
  test.run_for(run_s);
  return images.last();
}

inline std::string metadata(const shoal::image_t& image, const std::string& key) {
  for (const auto& entry : image.metadata)
    if (entry.key == key) return {entry.value.begin(), entry.value.end()};
  return "none";
}

template <typename T>
T value_at(const shoal::image_t& image, int column, int row) {
  T value;
  std::memcpy(&value, image.data.data() + row * image.row_stride + column * static_cast<int>(sizeof(T)), sizeof value);
  return value;
}

inline const std::string labels = ", image: segmentation_vehicles";

/// A stereo pair with a baseline of 0.12 m, at the same times; `more`: keys of the right one.
inline std::string stereo_pair(const std::string& more = "") {
  const std::string lens = ", type: camera, width: 640, height: 48, rate_hz: 10, phase_s: 0.05";
  return "        - {name: right, position_m: [0, -0.06, 0.4], right_of: left" + lens + more +
         "}\n        - {name: left, position_m: [0, 0.06, 0.4]" + lens + ", image: segmentation_vehicles}\n";
}

}  // namespace camera_worlds
