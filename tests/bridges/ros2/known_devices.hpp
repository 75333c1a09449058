// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shoal/image_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace known_devices {

/// A context after a scene with these devices of the vehicle auv1, and a moving arm.
inline bridges::ros2::ConverterContext knowing(const std::string& devices) {
  bridges::ros2::ConverterContext context;
  shoal::sim_scene_t scene{};
  scene.scene = R"({"bodies": [{"id": 4, "name": "auv1/arm", "owner": "auv1"}], "vehicles": [{"name": "auv1",
      "body": 3, "pose": [0, 0, -1, 1, 0, 0, 0], "devices": [)" +
                devices + "]}]}";
  EXPECT_FALSE(test::converted(scene, "/tf", "sim.scene", &context));
  return context;
}

inline std::string device_with(const std::string& field_of_view) {
  return R"({"name": "x", "body": 3, "channels": ["auv1.x"], "field_of_view": )" + field_of_view + "}";
}

/// Reads frames as `parent > child`, with their poses x, y, z, qx, qy, qz, qw.
inline std::map<std::string, std::vector<double>> frames_of(std::optional<test::CdrReader> in) {
  std::map<std::string, std::vector<double>> frames;
  if (!in) return frames;
  const auto count = in->number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    in->skip<std::uint32_t>(2);
    std::string name = in->text() + " > ";
    name += in->text();
    for (int k = 0; k < 7; ++k) frames[name].push_back(in->number<double>());
  }
  EXPECT_TRUE(in->at_end());
  return frames;
}

inline auto near_to(std::vector<double> values) {
  std::vector<testing::Matcher<double>> each;
  for (const double value : values) each.push_back(testing::DoubleNear(value, 1e-12));
  return testing::ElementsAreArray(each);
}

inline shoal::image_t image_of(std::int32_t pixelformat, const std::string& key, const std::string& value) {
  shoal::image_t image{};
  image.utime = 1'500'000;
  image.width = 2;
  image.height = 1;
  image.row_stride = 4;
  image.pixelformat = pixelformat;
  image.data = {1, 2, 3, 4};
  image.size = 4;
  image.nmetadata = 1;
  image.metadata.resize(1);
  image.metadata[0].key = key;
  image.metadata[0].n = static_cast<std::int32_t>(value.size());
  image.metadata[0].value.assign(value.begin(), value.end());
  return image;
}

}  // namespace known_devices
