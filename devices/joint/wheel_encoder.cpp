// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/wheel_encoder.hpp"

#include <algorithm>
#include <cmath>

#include "devices/common/same_size.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/wheel_encoder_t.hpp"

namespace devices {

void WheelEncoder::Params::read(sim::ParamReader& in) {
  in.require("joints");
  in.read_references("joints", joints, "joint", "joints of the wheels, in the order of the report");
  if (!in.describing() && in.has("joints") && joints.empty()) in.error("joints", "'joints' must name a joint");
  in.read("ticks_per_revolution", ticks_per_revolution, sim::at_least(1), "ticks in one turn of a wheel");
  in.read("missed_ticks", missed_ticks, sim::between(0, 1), "probability that a tick is not counted");
  in.read("noise", noise, "error of the angle a wheel turned between two samples, rad");
}

namespace {

/// Largest count, which a double holds exactly: 30 000 years at 10 kHz.
constexpr std::int64_t max_ticks = std::int64_t{1} << 53;

std::vector<WheelEncoder::Wheel> wheels_of(const WheelEncoder::Params& params, const sim::DeviceContext& context) {
  std::vector<WheelEncoder::Wheel> wheels;
  for (const std::string& name : params.joints) {
    const sim::Joint& joint = joint_with_axis(context, name, 0);
    if (!sim::joint_info(joint.type()).turns) refuse(context, "joint '" + name + "' is a slider and does not turn");
    wheels.push_back({name, &joint, joint.axes() - 1});
  }
  return wheels;
}

}  // namespace

WheelEncoder::WheelEncoder(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      wheels_(wheels_of(params, context)),
      noise_(context, params, static_cast<int>(wheels_.size())),
      angles_rad_(wheels_.size()),
      believed_rad_(wheels_.size()),
      passed_(wheels_.size()),
      counted_(wheels_.size()),
      ticks_(wheels_.size()),
      rates_radps_(wheels_.size()) {}

std::int64_t WheelEncoder::ticks_at(double angle_rad) const {
  const double ticks = std::floor(angle_rad / (2 * std::numbers::pi) * params_.ticks_per_revolution);
  return static_cast<std::int64_t>(std::clamp<double>(ticks, -max_ticks, max_ticks));
}

void WheelEncoder::measure(const sim::SenseContext&) {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const Wheel& wheel = wheels_[i];
    ticks_[i] = ticks_at(wheel.joint->position(wheel.axis));
    rates_radps_[i] = wheel.joint->velocity(wheel.axis);
  }
}

/// Returns the number of missed ticks, which are independent: binomially distributed with `passed` trials.
std::int64_t WheelEncoder::missed_of(std::int64_t passed, sim::Random& random) const {
  if (params_.missed_ticks <= 0) return 0;
  // Draw few ticks one by one, and many with the normal approximation of the binomial distribution.
  constexpr std::int64_t few = 1000;
  const double p = params_.missed_ticks;
  if (passed > few) {
    const auto n = static_cast<double>(passed);
    const auto missed = std::llround(n * p + std::sqrt(n * p * (1 - p)) * random.gaussian());
    return std::clamp<std::int64_t>(missed, 0, passed);
  }
  std::int64_t missed = 0;
  for (std::int64_t i = 0; i < passed; ++i) missed += random.uniform() < p ? 1 : 0;
  return missed;
}

void WheelEncoder::disturb(double dt_s, sim::Random& random) {
  std::vector<double> turned_rad(wheels_.size());
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double angle_rad = wheels_[i].joint->position(wheels_[i].axis);
    turned_rad[i] = angle_rad - angles_rad_[i];
    angles_rad_[i] = angle_rad;
  }
  noise_.apply(std::span<double>(turned_rad), dt_s, random);
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    // The error accumulates in the angle, not in the ticks, so that an error below one tick is not rounded away at
    // every sample.
    believed_rad_[i] += turned_rad[i];
    const std::int64_t passed = ticks_at(believed_rad_[i]) - passed_[i];
    passed_[i] += passed;
    const std::int64_t missed = missed_of(std::abs(passed), random);
    const std::int64_t counted = passed < 0 ? passed + missed : passed - missed;
    counted_[i] += counted;
    ticks_[i] = counted_[i];
    const double rad = static_cast<double>(counted) * 2 * std::numbers::pi / params_.ticks_per_revolution;
    rates_radps_[i] = dt_s > 0 ? rad / dt_s : 0;
  }
}

void WheelEncoder::visit_state(sim::StateArchive& archive) {
  for (auto* angles : {&angles_rad_, &believed_rad_, &rates_radps_}) visit_same_size(archive, *angles, "wheels");
  for (auto* counts : {&passed_, &counted_, &ticks_}) {
    visit_same_size(archive, *counts, "wheels");
    for (const std::int64_t count : *counts) archive.require(count, -max_ticks, max_ticks, "a count of ticks");
  }
  archive(noise_);
}

void fill(const WheelEncoder& encoder, shoal::wheel_encoder_t& message) {
  message.count = static_cast<std::int32_t>(encoder.wheels().size());
  for (const WheelEncoder::Wheel& wheel : encoder.wheels()) message.joint.push_back(wheel.name);
  message.ticks.assign(encoder.ticks().begin(), encoder.ticks().end());
  message.rate_radps = encoder.rates_radps();
}

SHOAL_SENSOR("wheel_encoder", WheelEncoder, shoal::wheel_encoder_t);

}  // namespace devices
