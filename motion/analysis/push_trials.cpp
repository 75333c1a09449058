// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/push_trials.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <span>

#include "motion/analysis/motion_tracking.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/world/world_state.hpp"

namespace motion {

namespace {

/// How the first body of a vehicle moves after a step.
struct BaseState {
  sim::Vector3d up_V, v_V, w_V;  ///< the vertical, and velocities, in the frame of the vehicle
  bool has_tilted, touches;

  BaseState(const sim::World& world, const sim::Vehicle& vehicle)
      : up_V(vehicle.X_WV().linear().row(2)),
        v_V(vehicle.X_WV().linear().transpose() * vehicle.base().v_WB_W()),
        w_V(vehicle.X_WV().linear().transpose() * vehicle.base().w_WB_W()),
        has_tilted(tilt_rad(vehicle) > fallen_rad),
        touches(first_body_touches(world, vehicle)) {}

  /// Returns whether both move alike: 10 mm/s, and 0.1 rad/s, which are 15 mm/s at the top of an ERS-7.  The tilt may
  /// differ by 10 degrees, because the feet may have slipped.
  bool is_like(const BaseState& other) const {
    return (up_V - other.up_V).norm() < 0.175 && (v_V - other.v_V).norm() < 0.01 && (w_V - other.w_V).norm() < 0.1;
  }
};

/// States without a push, by step.
using Course = std::vector<BaseState>;

constexpr double recovered_s = 0.06;  // that it must move as without a push

/// Steps of a push, and of the time in which it may fall.
struct PushSteps {
  int push, all;
  PushSteps(const sim::World& world, const PushOptions& options)
      : push(std::max(1, static_cast<int>(std::lround(options.push_s / sim::to_seconds(world.step_time()))))),
        all(push + static_cast<int>(std::lround(options.watch_s / sim::to_seconds(world.step_time())))) {}
};

/// A copy of the world in which a vehicle is pushed.
class PushWorld {
 public:
  explicit PushWorld(const MotionStage& stage) : stage_(stage), copy_(stage.copy()) {}

  /// `course`: it ends when it moves again as there.
  PushOutcome push(const sim::Bytes& snapshot, const sim::Vector3d& impulse_per_mass_V, const PushOptions& options,
                   std::span<const BaseState> course = {}) {
    sim::World& world = *copy_;
    stage_.restore(world, snapshot);
    const sim::Vehicle& vehicle = *world.find_vehicle(stage_.vehicle().name());
    world.physics().watch_contacts(vehicle.group());
    sim::Body& base = *vehicle.bodies().front().second;
    // Directions are those of the vehicle, level.
    const sim::Matrix3d R_WV = vehicle.X_WV().linear();
    const double yaw_rad = std::atan2(R_WV(1, 0), R_WV(0, 0));
    const sim::Vector3d impulse_W_Ns =
        mass_kg(vehicle) * (sim::rotation_from_rpy({0, 0, yaw_rad}) * impulse_per_mass_V);
    const double step_s = sim::to_seconds(world.step_time());
    const PushSteps steps(world, options);
    PushOutcome outcome;
    bool touched = false;
    double alike_s = 0;
    for (int i = 0; i < steps.all && !outcome.fell && alike_s < recovered_s; ++i) {
      if (i < steps.push) base.add_force_W(impulse_W_Ns / (steps.push * step_s), base.X_WB() * base.p_BC());
      world.step();
      stage_.apply_changes(world);
      const BaseState state(world, vehicle);
      if (i == 0) touched = state.touches;
      outcome.fell = state.has_tilted || (state.touches && !touched);
      const auto step = static_cast<std::size_t>(i);
      const bool is_alike = i >= steps.push && step < course.size() && state.is_like(course[step]);
      alike_s = is_alike ? alike_s + step_s : 0;
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
  std::unique_ptr<sim::StandaloneWorld> copy_;
};

sim::Vector3d along(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad), 0};
}

/// Worlds that threads take and give back.
class PushWorlds {
 public:
  explicit PushWorlds(const MotionStage& stage) : stage_(stage) {}

  PushOutcome push(const sim::Bytes& snapshot, const sim::Vector3d& impulse, const PushOptions& options,
                   std::span<const BaseState> course = {}) {
    std::unique_ptr<PushWorld> world = take();
    const PushOutcome outcome = world->push(snapshot, impulse, options, course);
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
  // Each thread has its own world, which continues from the snapshots.
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
  PushWorlds worlds(stage);
  sim::ThreadPool pool(options.threads);
  std::vector<PushOutcome> alone(margins.size());
  pool.for_each(margins.size(),
                [&](std::size_t i) { alone[i] = worlds.push(snapshots[i], sim::Vector3d::Zero(), options); });
  // Each direction of each instant has its own search.
  std::vector<double> settle_m(margins.size() * directions, 0.0);
  pool.for_each(margins.size() * directions, [&](std::size_t i) {
    const std::size_t instant = i / directions, direction = i % directions;
    const double angle_rad = 2 * std::numbers::pi * static_cast<double>(direction) / options.directions;
    const auto pushed = [&](double mps) { return worlds.push(snapshots[instant], mps * along(angle_rad), options); };
    const auto falls = [&](double mps) { return pushed(mps).fell; };
    if (options.settle_mps > 0) settle_m[i] = pushed(options.settle_mps).distance_m(alone[instant]);
    double withstood = 0, fell = options.greatest_mps;
    if (alone[instant].fell) return;  // it falls by itself
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

namespace {

/// The course of a vehicle without pushes, and snapshots at instants of it.
struct WatchedInstants {
  Course course;
  std::vector<sim::Bytes> snapshots;
  std::vector<std::size_t> starts;  ///< steps of the course
  std::size_t watched = 0;          ///< steps in which a push may make it fall

  WatchedInstants(MotionStage& stage, const std::vector<double>& instants_s, const PushOptions& options) {
    stage.go_to(instants_s.front());
    const int group = stage.vehicle().group();
    stage.world().physics().watch_contacts(group);
    stage.after_step = [&](MotionStage& now) { course.emplace_back(now.world(), now.vehicle()); };
    for (const double at_s : instants_s) {
      stage.go_to(at_s);
      starts.push_back(course.size());
      snapshots.push_back(stage.world().state().snapshot());
    }
    const PushSteps steps(stage.world(), options);
    watched = static_cast<std::size_t>(steps.all);
    stage.go_to(stage.now_s() + steps.all * sim::to_seconds(stage.world().step_time()));
    stage.after_step = {};
    stage.world().physics().unwatch_contacts(group);
  }

  std::span<const BaseState> after(std::size_t instant) const {
    return std::span(course).subspan(starts[instant], watched);
  }
  bool falls_after(std::size_t instant) const {
    const std::span<const BaseState> states = after(instant);
    return std::any_of(states.begin(), states.end(), [&](const BaseState& state) {
      return state.has_tilted || (state.touches && !states.front().touches);
    });
  }
};

}  // namespace

WeakestPush weakest_push(MotionStage& stage, const std::vector<double>& instants_s, const PushOptions& options) {
  const WatchedInstants instants(stage, instants_s, options);
  WeakestPush weakest;
  weakest.mass_kg = PushWorld::mass_kg(stage.vehicle());
  for (std::size_t i = 0; i < instants_s.size() && !weakest.falls; ++i) {
    weakest.falls = instants.falls_after(i);
    weakest.at_s = instants_s[i];
  }
  if (weakest.falls) return weakest;
  PushWorlds worlds(stage);
  sim::ThreadPool pool(options.threads);
  const auto directions = static_cast<std::size_t>(options.directions);
  const auto angle_rad = [&](std::size_t push) {
    return 2 * std::numbers::pi * static_cast<double>(push % directions) / options.directions;
  };
  // Returns those of the pushes that make it fall.
  const auto falling = [&](const std::vector<std::size_t>& pushes, double mps) {
    std::vector<char> fell(pushes.size());
    pool.for_each(pushes.size(), [&](std::size_t i) {
      const std::size_t at = pushes[i] / directions;
      const sim::Vector3d impulse = mps * along(angle_rad(pushes[i]));
      fell[i] = worlds.push(instants.snapshots[at], impulse, options, instants.after(at)).fell ? 1 : 0;
    });
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < pushes.size(); ++i)
      if (fell[i] != 0) found.push_back(pushes[i]);
    return found;
  };
  // The least margin of some pushes is an upper bound; of the others, most need one push to be above it.
  std::vector<std::size_t> some, others;
  const std::size_t all = instants_s.size() * directions;
  const std::size_t stride = std::max<std::size_t>(1, all / 32) | 1;  // odd: all of eight directions
  for (std::size_t i = 0; i < all; ++i) (i % stride == 0 ? some : others).push_back(i);
  double withstood = options.greatest_mps, fell = withstood;
  std::vector<std::size_t> falls_at;
  const auto narrow = [&](const std::vector<std::size_t>& pushes) {
    std::vector<std::size_t> first = falling(pushes, withstood);
    if (first.empty()) return;
    falls_at = std::move(first);
    fell = withstood;
    withstood = 0;
    // Bisection, only with the pushes that made it fall at the larger impulse: the others withstand smaller ones.
    while (fell - withstood > options.resolution_mps) {
      const double middle = (withstood + fell) / 2;
      std::vector<std::size_t> found = falling(falls_at, middle);
      if (found.empty())
        withstood = middle;
      else
        fell = middle, falls_at = std::move(found);
    }
  };
  narrow(some);
  if (withstood > 0) narrow(others);
  weakest.withstood_mps = withstood;
  weakest.is_beyond = falls_at.empty();
  if (falls_at.empty()) return weakest;
  weakest.at_s = instants_s[falls_at.front() / directions];
  weakest.direction_rad = angle_rad(falls_at.front());
  return weakest;
}

}  // namespace motion
