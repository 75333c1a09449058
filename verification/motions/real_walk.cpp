// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/real_walk.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "devices/joint/joint_servo.hpp"
#include "motion/analysis/perturbed_world.hpp"
#include "sim/base/thread_pool.hpp"

namespace verification {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
/// Endings of the servos of a leg.
constexpr const char* leg_joints[] = {"_swing", "_flap", "_knee"};

bool is_of_leg(const std::string& servo) {
  return std::any_of(std::begin(leg_joints), std::end(leg_joints),
                     [&](const char* ending) { return servo.ends_with(ending); });
}

}  // namespace

std::vector<RealWalk> fast_forward_strides() {
  // Command in cm per half step, speed in cm/s.
  const double cm[][2] = {{1, 4.36},  {2, 12.28}, {3, 18.12}, {4, 25.25},  {5, 32.32},
                          {6, 36.54}, {7, 39.19}, {8, 39.73}, {8.2, 41.01}};
  std::vector<RealWalk> walks;
  for (const auto& [stride, speed] : cm)
    walks.push_back({{.forward_m = stride / 100}, speed / 100, stride == 2 || stride == 5 || stride == 8});
  return walks;
}

std::vector<RealWalk> fast_forward_turns() {
  const double deg[][2] = {{5, 22.3512},  {10, 43.4592}, {15, 59.1784}, {20, 69.4455},
                           {25, 78.8782}, {30, 88.8216}, {35, 91.5167}};
  std::vector<RealWalk> walks;
  for (const auto& [turn, speed] : deg) walks.push_back({{.turn_rad = turn * rad_per_deg}, speed * rad_per_deg});
  return walks;
}

sim::WorldConfig with_parameters(sim::WorldConfig world, const std::string& vehicle, const DogParameters& parameters) {
  motion::Perturbation perturbation;
  perturbation.friction = parameters.friction;
  world = motion::perturbed(std::move(world), vehicle, perturbation);
  for (sim::VehicleInstance& instance : world.vehicles) {
    if (instance.name != vehicle) continue;
    sim::VehicleConfig changed = *instance.config;
    for (sim::DeviceConfig& device : changed.devices) {
      const auto* own = dynamic_cast<const sim::detail::ParamsOf<devices::JointServo::Params>*>(device.params.get());
      if (own == nullptr || !is_of_leg(device.name)) continue;
      auto params = std::make_shared<sim::detail::ParamsOf<devices::JointServo::Params>>(*own);
      devices::JointServo::Params& servo = params->params;
      servo.max_effort = parameters.effort_Nm.value_or(servo.max_effort);
      servo.kp = parameters.gain_per_s.value_or(servo.kp);
      servo.max_velocity *= parameters.speed_factor.value_or(1);
      servo.gear.play = parameters.play_rad.value_or(servo.gear.play);
      if (device.name.ends_with("_flap")) servo.kp *= parameters.flap_factor.value_or(1);
      device.params = std::move(params);
    }
    instance.config = std::make_shared<const sim::VehicleConfig>(std::move(changed));
  }
  return world;
}

std::vector<double> simulated_speeds(const sim::WorldConfig& world, const std::string& vehicle,
                                     std::span<const RealWalk> walks, const motion::WalkOptions& options, int threads) {
  const sim::WorldConfig reduced = motion::world_for_walks(world);
  const auto instance = std::find_if(reduced.vehicles.begin(), reduced.vehicles.end(),
                                     [&](const sim::VehicleInstance& one) { return one.name == vehicle; });
  const motion::Skelliptical gait(*instance->config);
  const std::vector<double> numbers = motion::Skelliptical::fast_forward();
  std::vector<double> speeds(walks.size());
  sim::ThreadPool(threads).for_each(walks.size(), [&](std::size_t i) {
    const motion::GaitStep& step = walks[i].step;
    const motion::Walk walk =
        motion::measured_walk(reduced, vehicle, gait.motion(numbers, step, motion::CourseLimit::range), options);
    if (!walk.fell) speeds[i] = step.turn_rad != 0 ? walk.turn_radps : walk.ahead_mps;
  });
  return speeds;
}

double relative_rms(std::span<const RealWalk> walks, std::span<const double> simulated, bool only_fitted) {
  double sum2 = 0;
  int count = 0;
  for (std::size_t i = 0; i < walks.size(); ++i) {
    if (only_fitted && !walks[i].is_fitted) continue;
    const double error = simulated[i] / walks[i].measured - 1;
    sum2 += error * error;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum2 / count);
}

}  // namespace verification
