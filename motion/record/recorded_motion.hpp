// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "motion/record/take.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

/// Tolerance of the keys of a recording, rad or m: 0.25 degrees.
constexpr double key_tolerance = 0.00436332312998582;

/// Returns a recording over a motion as frames: played in the same world, it gives the same state, bit for bit.
/// `base`: the motion over which it was recorded; of a new one, empty except for its name.  Joints that were not
/// recorded keep their keys.
sim::JointMotion exact_motion(const Take& take, const sim::JointMotion& base);

/// Returns the same as keys, within a tolerance.  Outside of the part that was recorded the keys stay.  Where a key of
/// a recorded joint would come at the time of a key with an easing, the recorded joints stay frames.
sim::JointMotion keyed_motion(const Take& take, const sim::JointMotion& base, double tolerance = key_tolerance);

/// Returns the path of the exact motion beside that of the keys: `wave.yaml` gives `wave_take.yaml`.
std::string take_path(const std::string& path);
/// Returns the path of the journal of a recording that lasts: `wave.yaml.journal`.
std::string journal_path(const std::string& path);

/// Readable part of a journal.
struct RecoveredTake {
  Take take;
  std::optional<TakeDamage> damage;  ///< unset: all of it was read
};
/// Reads the journal of a motion file; nothing: there is none, or its program ended before the first frame, and it is
/// removed.  Throws sim::ConfigError for one without a good frame, and for what is not a journal.
std::optional<RecoveredTake> read_journal(const std::string& path);

/// Files that save_take() wrote.
struct SavedTake {
  sim::JointMotion motion;      ///< with keys
  std::string damaged_journal;  ///< where a damaged journal is kept: `wave.yaml.journal.bad`; empty: it was not
};
/// Writes both motions of a journal, and removes it, or keeps a damaged one under another name.  The present version
/// of the file goes to its history first, with `operation`.  `state_hash`: of the world at the end; empty: unknown.
/// Throws sim::ConfigError for an invalid motion over which it was recorded, std::runtime_error when something cannot
/// be written.
SavedTake save_take(const std::string& path, const RecoveredTake& recovered, const std::string& state_hash,
                    const std::string& operation);

}  // namespace motion
