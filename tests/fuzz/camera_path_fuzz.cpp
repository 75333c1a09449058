// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "viewer/film/camera_path.hpp"
#include "viewer/film/overlay.hpp"

// Key poses of the camera of a film, and its list of overlays.

SHOAL_FUZZ_TARGET(camera_path) {
  fuzz::allow<std::invalid_argument>([&] { viewer::parse_overlays(std::string(fuzz::text_of(input))); });
  const std::string path = fuzz::write_scratch("path.yaml", input);
  fuzz::allow<sim::ConfigError>([&] {
    const viewer::CameraPath keys = viewer::read_camera_path(path);
    for (const double share : {-0.5, 0.0, 0.3, 0.9, 1.5})
      keys.at(keys.keys.front().at_s + share * (keys.keys.back().at_s - keys.keys.front().at_s));
  });
}
