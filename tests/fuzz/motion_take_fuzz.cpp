// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/key_events.hpp"
#include "motion/record/recorded_motion.hpp"
#include "sim/motion/motion.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// The journal of a recording, and the same bytes as keys of a terminal.

SHOAL_FUZZ_TARGET(motion_take) {
  experiment::KeyEvents keys;
  for (const char byte : fuzz::text_of(input))
    if (const auto event = keys.next(byte)) fuzz::require(!event->key.empty(), "an event has a key");
  fuzz::allow<sim::ConfigError>([&] {
    std::optional<motion::TakeDamage> damage;
    const motion::Take take = motion::parse_take(fuzz::text_of(input), "journal", &damage);
    fuzz::require(!damage || damage->lines > 0, "a bad line is dropped");
    fuzz::require(take.frame_count() > 0, "a recording has a frame");
    for (const std::vector<double>& values : take.frames)
      fuzz::require(values.size() == take.frame_count(), "each joint has a value in each frame");
    // A motion of the same length.
    sim::JointMotion base;
    base.name = "motion";
    const double end_s = static_cast<double>(take.frame_count() - 1) * take.settings.frame_s;
    const sim::JointMotion exact = motion::exact_motion(take, base);
    fuzz::require(exact.end_s() <= end_s + 1e-9, "a motion is not longer than its recording");
    fuzz::require(motion::keyed_motion(take, base).end_s() <= end_s + 1e-9, "keys lie within the recording");
  });
}
