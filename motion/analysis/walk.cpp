// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/walk.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "devices/motion/motion_player.hpp"
#include "motion/analysis/motion_tracking.hpp"
#include "motion/analysis/perturbed_world.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world/world_state.hpp"

namespace motion {

namespace {

constexpr double max_approach_s = 60;
constexpr double worst_fall_mps = -0.3, best_fall_mps = -0.1;

/// A world is made and removed by one thread at a time.
std::mutex& building() {
  static std::mutex mutex;
  return mutex;
}

const devices::MotionPlayer& player_of(const sim::Vehicle& vehicle) {
  for (const sim::MountedDevice* device : vehicle.devices())
    if (const auto* player = dynamic_cast<const devices::MotionPlayer*>(device->sensor())) return *player;
  throw std::logic_error("only a vehicle with a motion_player can walk");
}

double yaw_of(const sim::Vehicle& vehicle) {
  const sim::Vector3d ahead = vehicle.X_WV().linear().col(0);
  return std::atan2(ahead.y(), ahead.x());
}

/// Way of a vehicle along its own direction, and how far it has turned, also beyond a whole turn.
class Odometer {
 public:
  explicit Odometer(const sim::Vehicle& vehicle)
      : vehicle_(vehicle), position_W_(vehicle.X_WV().translation()), yaw_rad_(yaw_of(vehicle)) {}

  void add() {
    const double yaw_rad = yaw_of(vehicle_), turned_rad = std::remainder(yaw_rad - yaw_rad_, 2 * std::numbers::pi);
    const double mean_rad = yaw_rad_ + turned_rad / 2;
    const sim::Vector3d moved_W = vehicle_.X_WV().translation() - position_W_;
    ahead_m += std::cos(mean_rad) * moved_W.x() + std::sin(mean_rad) * moved_W.y();
    turn_rad += turned_rad;
    position_W_ = vehicle_.X_WV().translation();
    yaw_rad_ = yaw_rad;
  }

  double ahead_m = 0, turn_rad = 0;

 private:
  const sim::Vehicle& vehicle_;
  sim::Vector3d position_W_;
  double yaw_rad_;
};

/// Steps a world until a time; stops at a fall.
class Walker {
 public:
  Walker(sim::World& world, const sim::Vehicle& vehicle) : world_(world), vehicle_(vehicle) {}

  double now_s() const { return sim::to_seconds(world_.now()); }
  bool fell() const { return fell_; }
  void step() {
    try {
      world_.step();
    } catch (const sim::PhysicsFault&) {
      fell_ = true;
    }
    fell_ = fell_ || tilt_rad(vehicle_) > fallen_rad || first_body_touches(world_, vehicle_);
  }
  void walk_until(double end_s, Odometer* odometer = nullptr) {
    while (!fell_ && now_s() < end_s - 1e-9) {
      step();
      if (odometer != nullptr) odometer->add();
    }
  }

 private:
  sim::World& world_;
  const sim::Vehicle& vehicle_;
  bool fell_ = false;
};

}  // namespace

Walk measured_walk(sim::WorldConfig config, const std::string& vehicle_name, const sim::JointMotion& motion,
                   const WalkOptions& options) {
  set_played_motion(config, vehicle_name, motion);
  std::unique_ptr<sim::StandaloneWorld> world;
  {
    const std::lock_guard lock(building());
    world = std::make_unique<sim::StandaloneWorld>(config);
  }
  const sim::Vehicle& vehicle = *world->find_vehicle(vehicle_name);
  world->physics().watch_contacts(vehicle.group());
  const double yaw_rad = yaw_of(vehicle);
  // Approach, warm up, and measure.
  Walker walker(*world, vehicle);
  const devices::MotionPlayer& player = player_of(vehicle);
  while (!walker.fell() && player.phase() == devices::MotionPlayer::Phase::approach && walker.now_s() < max_approach_s)
    walker.step();
  const double approached_s = walker.now_s();
  walker.walk_until(approached_s + options.warm_up_s);
  const sim::Vector3d start_W = vehicle.X_WV().translation();
  const double start_s = walker.now_s();
  Odometer odometer(vehicle);
  walker.walk_until(approached_s + options.warm_up_s + options.measured_s, &odometer);
  Walk walk;
  walk.fell = walker.fell();
  walk.at_s = walker.now_s();
  walk.state_hash = world->state().hash();
  if (walk.fell) {
    const double share = std::max(0.0, walk.at_s - approached_s) / (options.warm_up_s + options.measured_s);
    walk.value_mps = worst_fall_mps + (best_fall_mps - worst_fall_mps) * share;
  } else {
    const sim::Vector3d displacement_W = vehicle.X_WV().translation() - start_W;
    const double time_s = walk.at_s - start_s;
    walk.forward_mps = (std::cos(yaw_rad) * displacement_W.x() + std::sin(yaw_rad) * displacement_W.y()) / time_s;
    walk.sideways_mps = (std::cos(yaw_rad) * displacement_W.y() - std::sin(yaw_rad) * displacement_W.x()) / time_s;
    walk.ahead_mps = odometer.ahead_m / time_s;
    walk.turn_radps = odometer.turn_rad / time_s;
    walk.value_mps = walk.forward_mps - options.sideways * std::abs(walk.sideways_mps);
  }
  const std::lock_guard lock(building());
  world.reset();
  return walk;
}

}  // namespace motion
