// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/truth_history.hpp"

namespace experiment {

sim::Time true_time_of(const sim::World& world, const sim::Vehicle& vehicle, std::int64_t utime) {
  // Clock errors are known near the present only, so the difference of the stamp from the present clock reading is
  // used.
  const std::int64_t shown_us = world.epoch_us() + vehicle.clock().reading(world.now()).count();
  std::int64_t ahead_us = 0;
  if (__builtin_sub_overflow(utime, shown_us, &ahead_us)) return utime < shown_us ? sim::Time::min() : sim::Time::max();
  if (ahead_us <= -sim::VehicleClock::memory.count()) return sim::Time::min();
  if (ahead_us >= sim::VehicleClock::memory.count()) return sim::Time::max();
  return vehicle.clock().true_time(sim::Time{utime - world.epoch_us()});
}

TruthHistory::TruthHistory(const sim::World& world, const sim::Vehicle& vehicle)
    : world_(world),
      vehicle_(vehicle.name()),
      recent_(static_cast<std::size_t>(memory_s / sim::to_seconds(world.step_time())) + 1,
              Truth{vehicle.X_WV().translation(), 0}) {}

void TruthHistory::after_step() {
  const Truth& before = recent_[slot_of(world_.step_number() - 1)];
  const sim::Vector3d position_m = world_.find_vehicle(vehicle_)->X_WV().translation();
  // A vehicle that was placed elsewhere has not traveled the distance.
  constexpr double fastest_mps = 200;
  const double distance_m = (position_m - before.position_m).norm();
  const bool traveled = distance_m <= fastest_mps * sim::to_seconds(world_.step_time());
  recent_[slot_of(world_.step_number())] = {position_m, before.travelled_m + (traveled ? distance_m : 0)};
}

void TruthHistory::visit_state(sim::StateArchive& archive) {
  archive.expect_count(recent_.size(), "steps of truth");
  for (Truth& truth : recent_) archive(truth);
}

const TruthHistory::Truth& TruthHistory::now() const {
  return recent_[slot_of(world_.step_number())];
}

std::optional<TruthHistory::Truth> TruthHistory::at(sim::Time time) const {
  const std::int64_t step_us = world_.step_time().count();
  if (time.count() < 0 || time > world_.now() + world_.step_time()) return std::nullopt;
  const std::int64_t step = (time.count() + step_us / 2) / step_us;
  const bool forgotten = step <= world_.step_number() - static_cast<std::int64_t>(recent_.size());
  if (forgotten || step > world_.step_number()) return std::nullopt;
  return recent_[slot_of(step)];
}

}  // namespace experiment
