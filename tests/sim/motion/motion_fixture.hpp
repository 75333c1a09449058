// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>

#include "sim/motion/motion.hpp"
#include "tests/scratch_folder.hpp"

namespace motion_fixture {

inline const char* const wave = R"(shoal: 1
motion: wave
vehicle: ers7
ease: cosine
poses:
  - {name: stand, joints: {lf_knee: 30, rf_knee: 30, "PRM:/r2/c1-Joint2:21": -5}}
keys:
  - {at_s: 0, pose: stand}
  - {at_s: 0.5, joints: {lf_knee: 80}, ease: linear, note: up}
  - {at_s: 1, pose: stand, joints: {rf_knee: 40}}
)";

struct MotionFile {
  test_support::ScratchFolder folder;
  std::string path = folder.file("a.motion.yaml");

  explicit MotionFile(const std::string& text) { std::ofstream(path) << text; }
  sim::JointMotion load() const { return sim::load_motion(path); }
  std::string error() const {
    try {
      load();
      return {};
    } catch (const sim::ConfigError& error) {
      std::string text = error.what();
      for (std::size_t at; (at = text.find(path)) != std::string::npos;) text.replace(at, path.size(), "FILE");
      return text;
    }
  }
};

}  // namespace motion_fixture
