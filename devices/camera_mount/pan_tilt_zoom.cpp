// SPDX-License-Identifier: BSD-3-Clause
#include "devices/camera_mount/pan_tilt_zoom.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pan_tilt_zoom_command_t.hpp"
#include "shoal/pan_tilt_zoom_t.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr double max_target = 1e6;  // rad or rad/s, beyond all joints
constexpr const char* axis_names[] = {"pan", "tilt", "zoom"};
/// Members of the command.
constexpr const char* position_names[] = {"pan_rad", "tilt_rad", "fov_rad"};
constexpr const char* velocity_names[] = {"pan_radps", "tilt_radps", "fov_radps"};

/// Returns what is wrong with the range of a lens; empty: nothing.
std::string problem_of(const sim::OpticsConfig& optics, double min_fov_rad, double max_fov_rad) {
  const auto degrees = [](double rad) { return fmt::format("{:g}", sim::radians_to_degrees(rad)); };
  if (optics.fov_rad < min_fov_rad || optics.fov_rad > max_fov_rad)
    return "'fov_deg' of the camera must be from " + degrees(min_fov_rad) + " to " + degrees(max_fov_rad) + ", got " +
           degrees(optics.fov_rad);
  for (const double fov_rad : {min_fov_rad, max_fov_rad}) {
    sim::OpticsConfig zoomed = optics;
    zoomed.fov_rad = fov_rad;
    if (const std::string problem = zoomed.problem(); !problem.empty())
      return "zoomed to " + degrees(fov_rad) + " degrees, " + problem;
  }
  return {};
}

}  // namespace

void PanTiltZoom::Params::read(sim::ParamReader& in) {
  in.read_name("pan", pan, "joint_servo that pans, by name or alias; unset: none");
  in.read_name("tilt", tilt, "joint_servo that tilts; unset: none");
  in.read_name("camera", camera, "camera that zooms, from its fov_deg on; unset: none");
  in.read_deg("pan_speed_degps", pan_speed_radps, sim::above_to(0, 36000),
              "maximum speed; the limit of the servo applies too");
  in.read_deg("tilt_speed_degps", tilt_speed_radps, sim::above_to(0, 36000),
              "maximum speed; the limit of the servo applies too");
  in.read_deg("zoom_speed_degps", zoom_speed_radps, sim::above_to(0, 36000),
              "maximum rate of change of the field of view");
  in.read_deg("min_fov_deg", min_fov_rad, sim::above_to(0, 360), "horizontal field of view when zoomed in");
  in.read("max_fov_deg", max_fov_deg, sim::above_to(0, 360), "when zoomed out; unset: fov_deg of the camera");
  in.read("angle_noise", angle_noise, "error of the reported positions of pan and tilt, rad");
  if (!in.describing() && pan.empty() && tilt.empty() && camera.empty())
    in.error("needs at least one of 'pan', 'tilt' and 'camera'");
}

PanTiltZoom::PanTiltZoom(const Params& params, const sim::DeviceContext& context)
    : params_(params), vehicle_(context.vehicle), noise_(context, params, 2) {
  positions_.fill(none);
  velocities_.fill(none);
  // Find the servos.
  std::vector<std::string> names;
  for (const Axis axis : {pan, tilt}) {
    const std::string& name = axis == pan ? params.pan : params.tilt;
    if (name.empty()) continue;
    const ServoOfVehicle servo = find_servo(context, axis_names[axis], name);
    if (!names.empty() && names.front() == servo.device)
      refuse(context, "'pan' and 'tilt' must be two servos, got '" + servo.device + "' twice");
    turning_[axis] =
        Turning{names.size(), &context.joint(servo.params->joint), servo.params->axis, servo.params->max_velocity};
    names.push_back(servo.device);
  }
  if (!names.empty()) servos_.emplace(context, names);
  // Find the camera.
  if (params.camera.empty()) return;
  find_camera(context);
  try {
    find_range(params);
  } catch (const std::runtime_error& error) {
    refuse(context, error.what());
  }
  motions_[zoom].set_point.position = optics_->fov_rad;
}

ServoOfVehicle PanTiltZoom::find_servo(const sim::DeviceContext& context, const char* key,
                                       const std::string& name) const {
  std::vector<std::string> known;
  for (const ServoOfVehicle& servo : servos_of(context.vehicle.config())) {
    known.push_back(servo.device);
    if (!servo.is_called(name)) continue;
    // A pan or tilt is an angle, and a slider moves in meters.
    if (context.joint(servo.params->joint).type() == sim::JointType::slider)
      refuse(context, fmt::format("'{}' must turn: the joint of '{}' is a slider", key, name));
    return servo;
  }
  refuse(context, fmt::format("'{}' must be a joint_servo of the vehicle, got '{}'{}{}", key, name,
                              sim::did_you_mean(name, known),
                              known.empty() ? "; it has none" : "; known: " + sim::list_text(known)));
}

void PanTiltZoom::find_camera(const sim::DeviceContext& context) {
  // The camera may follow in the file: at this point only its configuration exists.
  std::vector<std::string> known;
  for (const sim::DeviceConfig& device : context.vehicle.config().devices) {
    const auto* params = dynamic_cast<const sim::detail::ParamsOf<Camera::Params>*>(device.params.get());
    if (params == nullptr) continue;
    known.push_back(device.name);
    if (device.name == params_.camera) optics_ = params->params.optics;
  }
  if (!optics_)
    refuse(context, "'camera' must be a camera of the vehicle, got '" + params_.camera + "'" +
                        sim::did_you_mean(params_.camera, known) +
                        (known.empty() ? "; it has none" : "; known: " + sim::list_text(known)));
  if (!optics_->focal_px.empty())
    refuse(context, "'camera' must have 'fov_deg', not 'focal_px': '" + params_.camera + "' could not zoom");
}

void PanTiltZoom::find_range(const Params& params) {
  const double max_fov_rad = params.max_fov_deg ? sim::degrees_to_radians(*params.max_fov_deg) : optics_->fov_rad;
  if (const std::string problem = problem_of(*optics_, params.min_fov_rad, max_fov_rad); !problem.empty())
    throw std::runtime_error(problem);
  min_fov_rad_ = params.min_fov_rad;
  max_fov_rad_ = max_fov_rad;
}

void PanTiltZoom::change(const Params& params) {
  if (optics_) {
    find_range(params);
    double& fov_rad = motions_[zoom].set_point.position;
    fov_rad = std::clamp(fov_rad, min_fov_rad_, max_fov_rad_);
  }
  params_ = params;
}

double PanTiltZoom::low(Axis axis) {
  return axis == zoom ? min_fov_rad_ : servos_->low(turning_[axis]->servo);
}

double PanTiltZoom::high(Axis axis) {
  return axis == zoom ? max_fov_rad_ : servos_->high(turning_[axis]->servo);
}

double PanTiltZoom::max_speed(Axis axis) const {
  if (axis == zoom) return params_.zoom_speed_radps;
  return std::min(axis == pan ? params_.pan_speed_radps : params_.tilt_speed_radps, turning_[axis]->max_velocity_radps);
}

void PanTiltZoom::command(const std::array<Command, axes>& commands) {
  // Check all of them.
  for (const Axis axis : {pan, tilt, zoom}) {
    const auto& [position, velocity] = commands[axis];
    if (std::isinf(position) || std::isinf(velocity))
      throw std::runtime_error(fmt::format("'{}' and '{}' must be finite, or NaN for 'as before'", position_names[axis],
                                           velocity_names[axis]));
    if (!std::isnan(position) && velocity < 0)
      throw std::runtime_error(fmt::format("'{}' is the largest speed to '{}' and must be >= 0, got {}",
                                           velocity_names[axis], position_names[axis], sim::number_text(velocity)));
    const bool moves = !std::isnan(position) || !(std::isnan(velocity) || velocity == 0);
    if (moves && !has(axis)) throw std::runtime_error(fmt::format("the device has no axis '{}'", axis_names[axis]));
  }
  // Take them.
  for (const Axis axis : {pan, tilt, zoom}) {
    const auto& [position, velocity] = commands[axis];
    if (!has(axis) || (std::isnan(position) && std::isnan(velocity))) continue;
    Motion& motion = motions_[axis];
    if (axis != zoom) motion.set_point.position = servos_->set_point(turning_[axis]->servo);
    const bool runs = std::isnan(position) || velocity == 0;  // to a position without speed: it stops
    motion.mode = runs ? Mode::velocity : Mode::position;
    motion.target = std::clamp(runs ? velocity : position, -max_target, max_target);
    motion.speed = runs || std::isnan(velocity) ? no_limit : velocity;
  }
}

void PanTiltZoom::move(Axis axis, const sim::ActContext& context) {
  Motion& motion = motions_[axis];
  if (motion.mode == Mode::free) return;
  const bool to_position = motion.mode == Mode::position;
  const SetPoint::Limits limits{std::min(motion.speed, max_speed(axis)), no_limit};
  const double target = to_position ? std::clamp(motion.target, low(axis), high(axis)) : motion.target;
  SetPoint& at = motion.set_point;
  if (to_position)
    at.approach(target, limits, context.step_s);
  else
    at.run(target, low(axis), high(axis), limits, context.step_s);
  at.position = std::clamp(at.position, low(axis), high(axis));  // rounding
  if (axis != zoom) servos_->command(turning_[axis]->servo, at.position, context.now);
  const bool at_end = (target < 0 && at.position == low(axis)) || (target > 0 && at.position == high(axis));
  const bool is_there = to_position ? at.position == target : target == 0 || at_end;
  if (is_there) motion.mode = Mode::free;
}

void PanTiltZoom::set_lens() {
  if (camera_ == nullptr)  // devices of the vehicle command each other
    camera_ = const_cast<Camera*>(static_cast<const Camera*>(vehicle_.find_device(params_.camera)->sensor()));
  camera_->zoom(motions_[zoom].set_point.position);
}

void PanTiltZoom::act(const sim::ActContext& context) {
  if (context.effectiveness <= 0 || vehicle_.systems().estopped)
    for (Motion& motion : motions_) motion.mode = Mode::free;
  for (const Axis axis : {pan, tilt, zoom}) move(axis, context);
  if (optics_) set_lens();
}

void PanTiltZoom::measure(const sim::SenseContext&) {
  for (const Axis axis : {pan, tilt}) {
    if (!turning_[axis]) continue;
    positions_[axis] = turning_[axis]->joint->position(turning_[axis]->axis);
    velocities_[axis] = turning_[axis]->joint->velocity(turning_[axis]->axis);
  }
  if (!optics_) return;
  const Motion& lens = motions_[zoom];
  positions_[zoom] = lens.set_point.position;
  velocities_[zoom] = lens.mode == Mode::free ? 0 : lens.set_point.velocity;
}

void PanTiltZoom::disturb(double dt_s, sim::Random& random) {
  noise_.apply(std::span<double>(positions_).first(2), dt_s, random);
}

void PanTiltZoom::visit_state(sim::StateArchive& archive) {
  archive(noise_, motions_);
  archive.not_only_finite(positions_, velocities_);
  if (!archive.restoring()) return;
  for (const Axis axis : {pan, tilt, zoom})
    if (!has(axis) && motions_[axis].mode != Mode::free)
      archive.fail(std::string("the snapshot has a motion of the axis '") + axis_names[axis] +
                   "', which does not exist");
  if (!optics_) return;
  // Within the range in which every lens is valid.
  archive.require(motions_[zoom].set_point.position, min_fov_rad_, max_fov_rad_, "field of view");
  set_lens();
}

void PanTiltZoomController::receive(sim::Time, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::pan_tilt_zoom_command_t>(payload, shoal::Finite::any);
  mount_.command({{{command.pan_rad, command.pan_radps},
                   {command.tilt_rad, command.tilt_radps},
                   {command.fov_rad, command.fov_radps}}});
}

void fill(const PanTiltZoom& mount, shoal::pan_tilt_zoom_t& message) {
  message.pan_rad = mount.position(PanTiltZoom::pan);
  message.tilt_rad = mount.position(PanTiltZoom::tilt);
  message.fov_rad = mount.position(PanTiltZoom::zoom);
  message.pan_radps = mount.velocity(PanTiltZoom::pan);
  message.tilt_radps = mount.velocity(PanTiltZoom::tilt);
  message.fov_radps = mount.velocity(PanTiltZoom::zoom);
}

SHOAL_TRANSCEIVER("pan_tilt_zoom", PanTiltZoom, shoal::pan_tilt_zoom_t, PanTiltZoomController);

}  // namespace devices
