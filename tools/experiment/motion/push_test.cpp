// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/motion/push_test.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "sim/base/thread_pool.hpp"
#include "sim/world/world_state.hpp"
#include "tools/experiment/motion/motion_tracking.hpp"

namespace tools {

namespace {

/// A copy of the world in which a vehicle is pushed.
class PushWorld {
 public:
  explicit PushWorld(const MotionStage& stage) : stage_(stage), copy_(stage.copy()) {}

  PushOutcome push(const sim::Bytes& snapshot, const sim::Vector3d& impulse_per_mass_V, const PushOptions& options) {
    sim::World& world = copy_->world();
    world.state().restore(snapshot);
    const sim::Vehicle& vehicle = *world.find_vehicle(stage_.vehicle().name());
    world.physics().watch_contacts(vehicle.group());
    sim::Body& base = *vehicle.bodies().front().second;
    // Directions are those of the vehicle, level.
    const sim::Matrix3d R_WV = vehicle.X_WV().linear();
    const double yaw_rad = std::atan2(R_WV(1, 0), R_WV(0, 0));
    const sim::Vector3d impulse_W_Ns =
        mass_kg(vehicle) * (sim::rotation_from_rpy({0, 0, yaw_rad}) * impulse_per_mass_V);
    const double step_s = sim::to_seconds(world.step_time());
    const auto push_steps = std::max(1, static_cast<int>(std::lround(options.push_s / step_s)));
    const auto steps = push_steps + static_cast<int>(std::lround(options.watch_s / step_s));
    PushOutcome outcome;
    bool touched = false;
    for (int i = 0; i < steps && !outcome.fell; ++i) {
      if (i < push_steps) base.add_force_W(impulse_W_Ns / (push_steps * step_s), base.X_WB() * base.p_BC());
      world.step();
      const bool touches = first_body_touches(world, vehicle);
      if (i == 0) touched = touches;
      outcome.fell = tilt_rad(vehicle) > fallen_rad || (touches && !touched);
    }
    outcome.end_W = base.X_WB().translation();
    world.physics().unwatch_contacts(vehicle.group());
    return outcome;
  }

  static double mass_kg(const sim::Vehicle& vehicle) {
    double mass_kg = 0;
    for (const auto& [name, body] : vehicle.bodies()) mass_kg += body->mass_kg();
    return mass_kg;
  }

 private:
  const MotionStage& stage_;
  std::unique_ptr<StageCopy> copy_;
};

sim::Vector3d along(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad), 0};
}

/// Worlds that threads take and give back.
class PushWorlds {
 public:
  explicit PushWorlds(const MotionStage& stage) : stage_(stage) {}

  PushOutcome push(const sim::Bytes& snapshot, const sim::Vector3d& impulse, const PushOptions& options) {
    std::unique_ptr<PushWorld> world = take();
    const PushOutcome outcome = world->push(snapshot, impulse, options);
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(world));
    return outcome;
  }

 private:
  std::unique_ptr<PushWorld> take() {
    const std::lock_guard lock(mutex_);  // worlds are made one after the other
    if (free_.empty()) return std::make_unique<PushWorld>(stage_);
    std::unique_ptr<PushWorld> world = std::move(free_.back());
    free_.pop_back();
    return world;
  }

  const MotionStage& stage_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<PushWorld>> free_;
};

}  // namespace

double PushMargin::least_Ns() const {
  return mass_kg * *std::min_element(withstood_mps.begin(), withstood_mps.end());
}

double PushMargin::least_direction_rad() const {
  const auto weakest = std::min_element(withstood_mps.begin(), withstood_mps.end()) - withstood_mps.begin();
  return 2 * std::numbers::pi * static_cast<double>(weakest) / static_cast<double>(withstood_mps.size());
}

std::vector<PushOutcome> outcomes_of(MotionStage& stage, const std::vector<Push>& pushes, const PushOptions& options) {
  std::vector<sim::Bytes> snapshots;
  for (const Push& push : pushes) {
    stage.go_to(push.at_s);
    snapshots.push_back(stage.world().state().snapshot());
  }
  PushWorlds worlds(stage);
  std::vector<PushOutcome> outcomes(pushes.size());
  sim::ThreadPool(options.threads).for_each(pushes.size(), [&](std::size_t i) {
    outcomes[i] = worlds.push(snapshots[i], pushes[i].mps * along(pushes[i].direction_rad), options);
  });
  return outcomes;
}

std::vector<PushMargin> push_margins(MotionStage& stage, const std::vector<double>& instants_s,
                                     const PushOptions& options) {
  // Snapshots of the instants.
  std::vector<PushMargin> margins;
  std::vector<sim::Bytes> snapshots;
  const auto directions = static_cast<std::size_t>(options.directions);
  for (const double at_s : instants_s) {
    stage.go_to(at_s);
    margins.push_back({stage.now_s(), std::vector<double>(directions, 0.0), PushWorld::mass_kg(stage.vehicle()), 0});
    snapshots.push_back(stage.world().state().snapshot());
  }
  // Each direction of each instant has its own search.
  PushWorlds worlds(stage);
  std::vector<double> settle_m(margins.size() * directions, 0.0);
  sim::ThreadPool(options.threads).for_each(margins.size() * directions, [&](std::size_t i) {
    const std::size_t instant = i / directions, direction = i % directions;
    const double angle_rad = 2 * std::numbers::pi * static_cast<double>(direction) / options.directions;
    const auto pushed = [&](double mps) { return worlds.push(snapshots[instant], mps * along(angle_rad), options); };
    const auto falls = [&](double mps) { return pushed(mps).fell; };
    const PushOutcome alone = pushed(0);
    settle_m[i] = pushed(options.settle_mps).distance_m(alone);
    double withstood = 0, fell = options.greatest_mps;
    if (alone.fell) return;  // it falls by itself
    if (!falls(fell)) withstood = fell;
    while (fell - withstood > options.resolution_mps) {
      const double middle = (withstood + fell) / 2;
      (falls(middle) ? fell : withstood) = middle;
    }
    margins[instant].withstood_mps[direction] = withstood;
  });
  for (std::size_t i = 0; i < settle_m.size(); ++i)
    margins[i / directions].settle_m = std::max(margins[i / directions].settle_m, settle_m[i]);
  return margins;
}

}  // namespace tools
