// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_drive.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "devices/joint/joint_of_device.hpp"
#include "shoal/joint_settings_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/config/message_text.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

void JointDrive::Params::read(sim::ParamReader& in) {
  in.require("joint");
  in.read_reference("joint", joint, "joint", "joint that it drives; a ball needs 'motor: true'");
  in.read("axes", axes, sim::between(0, 2), "axes that it drives; unset: all axes of the joint");
  in.read("max_velocity", max_velocity, sim::above(0), "maximum command, rad/s or m/s");
  in.read("max_force", max_force, sim::above(0), "maximum effort on each axis, N m or N");
  power.read(in);
}

namespace {

sim::Joint& joint_with_motors(const sim::DeviceContext& context, const std::string& name) {
  sim::Joint& joint = context.joint(name);
  if (joint.axes() > 0) return joint;
  const bool ball = joint.type() == sim::JointType::ball;
  const std::string type(word_of(sim::joint_type_words, joint.type()));
  refuse(context, "joint '" + name + "' is " + (ball ? "a ball without 'motor: true'" : type + " and has no axis"));
}

std::vector<int> numbers_of(const JointDrive::Params& params, const sim::DeviceContext& context, int axes_of_joint) {
  std::vector<int> numbers;
  for (int axis = 0; axis < axes_of_joint && params.axes.empty(); ++axis) numbers.push_back(axis);
  for (const double given : params.axes) {
    const int axis = static_cast<int>(given);
    if (axis != given) refuse(context, "'axes' must be whole numbers, got " + sim::number_text(given));
    if (axis >= axes_of_joint)
      refuse(context, "joint '" + params.joint + "' has no axis " + std::to_string(axis) + ", it has " +
                          std::to_string(axes_of_joint));
    if (std::count(numbers.begin(), numbers.end(), axis) > 0)
      refuse(context, "'axes' names axis " + std::to_string(axis) + " twice");
    numbers.push_back(axis);
  }
  return numbers;
}

std::optional<double> if_finite(double stop) {
  return std::isfinite(stop) ? std::optional<double>(stop) : std::nullopt;
}

}  // namespace

JointDrive::JointDrive(const Params& params, const sim::DeviceContext& context)
    : params_(params), joint_(joint_with_motors(context, params.joint)), vehicle_(context.vehicle) {
  const sim::JointConfig& config = joint_config(context.vehicle, params.joint);
  const bool ball = joint_.type() == sim::JointType::ball;
  for (const int number : numbers_of(params, context, joint_.axes())) {
    const sim::JointAxisConfig& of_axis = number == 0 || ball ? config.axis1 : config.axis2;
    Axis axis{.number = number, .max_force = params.max_force};
    axis.low_stop = of_axis.low_stop.value_or(axis.low_stop);
    axis.high_stop = of_axis.high_stop.value_or(axis.high_stop);
    axis.has_stops = joint_.type() != sim::JointType::hinge2 || number == 0;
    axes_.push_back(axis);
  }
}

void JointDrive::act(const sim::ActContext& context) {
  if (vehicle_.systems().metered) joint_.measure_load();
  for (const Axis& axis : axes_)
    joint_.set_motor(axis.velocity, coasting_ ? 0 : context.effectiveness * axis.max_force, axis.number);
}

void JointDrive::make_safe(sim::SafeState safe) {
  coasting_ = safe == sim::SafeState::coast;
  for (Axis& axis : axes_) {
    axis.velocity = 0;
    axis.max_force = params_.max_force;
  }
}

void JointDrive::change(const Params& params) {
  params_ = params;
  for (Axis& axis : axes_) {
    axis.velocity = std::clamp(axis.velocity, -params_.max_velocity, params_.max_velocity);
    axis.max_force = std::min(axis.max_force, params_.max_force);
  }
}

double JointDrive::power_W() const {
  double sum_W = 0;
  for (const Axis& axis : axes_) sum_W += params_.power.of_motor(joint_, axis.number, params_.max_force);
  return sum_W;
}

void JointDrive::visit_state(sim::StateArchive& archive) {
  for (Axis& axis : axes_) archive(axis);
  archive(coasting_);
}

void JointDrive::check_stops(const Axis& axis, const Settings& settings) const {
  const auto text = [&](const std::string& rest) { return "axis " + std::to_string(axis.number) + ": " + rest; };
  for (const double stop : {settings.low_stop, settings.high_stop}) {
    if (std::isnan(stop)) continue;
    if (!axis.has_stops) throw std::runtime_error(text("the wheel of a hinge2 has no stops"));
    const std::string error = std::isfinite(stop) ? sim::error_of_stop(joint_.type(), stop) : "";
    if (!error.empty()) throw std::runtime_error(text(error));
  }
  // An infinite stop means none, but only on its own side.
  if (settings.low_stop == std::numeric_limits<double>::infinity() ||
      settings.high_stop == -std::numeric_limits<double>::infinity())
    throw std::runtime_error(text("to remove a stop, give -infinity as 'low_stop' or +infinity as 'high_stop'"));
}

JointDrive::Axis JointDrive::with(Axis axis, const Settings& settings) const {
  check_stops(axis, settings);
  if (std::isinf(settings.velocity) || std::isinf(settings.max_force))
    throw std::runtime_error("'velocity' and 'max_force' must not be infinite");
  if (settings.max_force < 0)
    throw std::runtime_error("'max_force' must be >= 0, got " + sim::number_text(settings.max_force));
  // NaN in a command means 'as before', the convention of all commands with several numbers.
  const auto take = [](double& value, double given) {
    if (!std::isnan(given)) value = given;
  };
  if (!std::isnan(settings.velocity))
    axis.velocity = std::clamp(settings.velocity, -params_.max_velocity, params_.max_velocity);
  if (!std::isnan(settings.max_force)) axis.max_force = std::min(settings.max_force, params_.max_force);
  take(axis.low_stop, settings.low_stop);
  take(axis.high_stop, settings.high_stop);
  if (axis.low_stop > axis.high_stop)
    throw std::runtime_error("axis " + std::to_string(axis.number) +
                             ": 'low_stop' must not be above 'high_stop', got " + sim::number_text(axis.low_stop) +
                             " and " + sim::number_text(axis.high_stop));
  return axis;
}

void JointDrive::set(int axis, const Settings& settings) {
  // All axes are checked before any is changed.
  std::vector<Axis> changed = axes_;
  bool found = false;
  for (Axis& each : changed) {
    if (axis != -1 && each.number != axis) continue;
    found = true;
    each = with(each, settings);
  }
  if (!found) throw std::runtime_error("it drives no axis " + std::to_string(axis));
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (changed[i].low_stop != axes_[i].low_stop || changed[i].high_stop != axes_[i].high_stop)
      joint_.set_stops(if_finite(changed[i].low_stop), if_finite(changed[i].high_stop), changed[i].number);
  axes_ = std::move(changed);
  coasting_ = false;
}

void JointDriveController::receive(sim::Time, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::joint_settings_t>(payload, shoal::Finite::any);
  drive_.set(message.axis, {message.velocity, message.max_force, message.low_stop, message.high_stop});
}

SHOAL_ACTUATOR("joint_drive", JointDrive, JointDriveController);

}  // namespace devices
