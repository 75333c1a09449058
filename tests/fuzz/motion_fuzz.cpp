// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion.hpp"
#include "sim/motion/motion_frames.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// A motion file and its frames.

SHOAL_FUZZ_TARGET(motion) {
  const std::string text(fuzz::text_of(input));
  sim::FramesError error;
  const std::vector<sim::MotionTrack> frames = sim::parse_motion_frames(text, error);
  fuzz::require(frames.empty() == !error.text.empty(), "frames or an error");
  fuzz::require(error.text.empty() || error.line > 0, "an error has a place");
  sim::Diagnostics diagnostics;
  sim::ConfigNode root = sim::parse_config_text(text, "motion", diagnostics);
  if (!diagnostics.ok()) return;
  sim::JointMotion motion;
  sim::ParamReader in(root, "", diagnostics);
  motion.read(in);
  in.finish();
  if (!diagnostics.ok()) return;
  // What it writes reads to the same.
  const std::string written = sim::motion_text(motion);
  sim::Diagnostics none;
  root = sim::parse_config_text(written, "written", none);
  sim::JointMotion again;
  sim::ParamReader second(root, "", none);
  again.read(second);
  second.finish();
  fuzz::require(none.ok(), "a motion can be read from its text");
  fuzz::require(sim::motion_text(again) == written, "a motion is the same after writing and reading");
}
