// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/state/state_archive.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Returns the true simulated time at which a vehicle's clock showed `utime`.  Accepts any 64 bits: out-of-range values
/// are clamped to the smallest or largest time.
sim::Time true_time_of(const sim::World& world, const sim::Vehicle& vehicle, std::int64_t utime);

/// Positions of a vehicle in the last seconds, and its distance traveled.
class TruthHistory {
 public:
  static constexpr double memory_s = 10;
  struct Truth {
    sim::Vector3d position_m = sim::Vector3d::Zero();
    double travelled_m = 0;  ///< distance traveled from the start
    void visit_state(sim::StateArchive& archive) { archive(position_m, travelled_m); }
  };

  /// The world must outlive this, and keep the vehicle.
  TruthHistory(const sim::World& world, const sim::Vehicle& vehicle);
  /// Call once after every step.
  void after_step();
  const Truth& now() const;
  /// Returns the truth at the step nearest to a time; std::nullopt if it lies in the future or before the history.
  std::optional<Truth> at(sim::Time time) const;
  void visit_state(sim::StateArchive& archive);

 private:
  std::size_t slot_of(std::int64_t step) const { return static_cast<std::size_t>(step) % recent_.size(); }

  const sim::World& world_;
  std::string vehicle_;        ///< by name, because a restored world may have built it again
  std::vector<Truth> recent_;  ///< ring by step number
};

}  // namespace experiment
