// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/collision/contact_report.hpp"
#include "sim/physics/parts.hpp"
#include "sim/physics/physics_types.hpp"
#include "sim/physics/shard_solver.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// What a step leaves to be asked for: the contacts of watched groups, the counts of its work, and whether ODE failed
/// in it.  This class owns nothing else, and no step depends on it.
///
/// collect() is called when all shards were stepped.  The contacts are then sorted by their parts, since shards come in
/// the order of their numbers, which is not that of the parts.  They are saved, for a report may be asked for between a
/// restored world and its next step, but they are not hashed.
class StepReport {
 public:
  /// `rows_of_joints`: of the largest island by joints alone.
  void collect(std::span<const Shard* const> stepped, int rows_of_joints);
  /// Throws the error of the first shard of the last step that has one.
  static void throw_first_fault(std::span<const Shard* const> stepped);
  /// Removes the contacts of a group.
  void remove(int group, const Parts& parts);

  std::span<const ContactReport> contacts() const { return contacts_; }
  const StepCounts& counts() const { return counts_; }
  /// Number of steps in which an island was too large for WorldStep, or WorldStep gave up on one.
  std::int64_t quick_steps() const { return quick_steps_; }
  /// Whether ODE threw an error within a step: the world cannot be stepped further, nor destroyed.
  bool broken() const { return broken_; }
  void visit_state(StateArchive& archive, const Parts& parts);

 private:
  std::vector<ContactReport> contacts_;
  StepCounts counts_;
  std::int64_t quick_steps_ = 0;
  bool broken_ = false;
};

}  // namespace sim
