// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "devices/autopilot/autopilot_control.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/autopilot_command_t.hpp"
#include "shoal/autopilot_state_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/station_command_t.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_checks.hpp"

namespace devices {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Reports an error unless `name` is a device that receives shoal.helm_command_t.
void check_helm(const sim::DeviceContext& context, const std::string& name) {
  if (name.empty()) return;
  for (const sim::DeviceConfig& device : context.vehicle.config().devices)
    if (device.name == name && device.type != "autopilot" &&
        device.device_type->command_messages.find("shoal.helm_command_t") != std::string::npos)
      return;
  refuse(context, "'helm' names no device '" + name + "' that takes shoal.helm_command_t");
}

double given(double value, double before) {
  return std::isnan(value) ? before : value;
}

double or_nothing(const std::optional<double>& value) {
  return value.value_or(nothing);
}

std::optional<double> if_number(double value) {
  return std::isnan(value) ? std::nullopt : std::optional<double>(value);
}

CraftAbilities abilities_of(const std::optional<AutopilotActuators>& actuators) {
  return actuators ? actuators->abilities() : CraftAbilities{};
}

}  // namespace

Autopilot::Autopilot(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      vehicle_(context.vehicle),
      body_(context.body),
      faults_(context.faults),
      warnings_(context.host.warnings),
      who_("device '" + context.full_name() + "'"),
      may_need_bottom_(needs_bottom()),
      surface_m_(world_.config().medium.water ? world_.config().medium.water->surface_m : 0),
      actuators_(params.helm.empty() ? std::make_optional<AutopilotActuators>(params, context) : std::nullopt),
      law_(params.gains, abilities_of(actuators_)),
      route_(params.guidance),
      circle_(params.circle_radius_m),
      mode_(params.first_mode()) {
  check_helm(context, params.helm);
  if (actuators_) check_level(*actuators_, params.gains.attitude, context);
  warn_of_no_speed(context);
  // Setpoints that are not given are those of the start, so that an autopilot without a command keeps the vehicle
  // where it is instead of moving it to zero.
  const HoldParams& hold = params.hold;
  desired_.speed_mps = hold.speed_mps;
  desired_.heading_rad =
      hold.heading_deg ? sim::degrees_to_radians(*hold.heading_deg) : sim::yaw_of(body_.X_WB().linear());
  depth_desired_m_ = depth_m();
  take_height(hold.depth_m, hold.altitude_m);
  if (mode_ == Mode::waypoints) start_route(params.route(), params.loop);
  if (mode_ == Mode::station) desired_.station_m = params.station.place_m.value_or(place());
  if (mode_ == Mode::circle) start_circle(params.station.place_m.value_or(place()));
}

/// Warns of a route that begins without a speed, unless something else in the world may command one.
void Autopilot::warn_of_no_speed(const sim::DeviceContext& context) const {
  if (mode_ != Mode::waypoints || params_.route().front().speed_mps.value_or(params_.hold.speed_mps) != 0) return;
  const sim::WorldConfig& world = context.world.config();
  std::set<std::string> published;
  for (const sim::EventConfig& event : world.events)
    for (const sim::ActionEntry& entry : event.actions)
      if (entry.action) entry.action->add_channels(published);
  const std::string commands =
      sim::device_channel(context.host.channels, vehicle_.name(), context.config, sim::ChannelKind::command);
  if (!world.processes.empty() || published.contains(commands)) return;
  const char* key = params_.lawnmower ? "lawnmower" : "waypoints";
  warnings_.building().warn(context.config.source ? sim::place_of(*context.config.source, key) : context.config.place,
                            "vehicle '" + vehicle_.name() + "': device '" + context.config.name + "'",
                            std::string("'") + key +
                                "' begins without a speed: the vehicle stands still until a command gives one; set "
                                "'speed_mps' there or in 'hold'");
}

std::string_view Autopilot::lacks() const {
  return mode_ == Mode::waypoints && desired_.speed_mps == 0 ? "speed for its route" : "";
}

std::vector<sim::PlannedPlace> Autopilot::planned_places() const {
  std::vector<sim::PlannedPlace> places;
  std::optional<double> depth_m = params_.hold.depth_m;
  if (depth_m) places.push_back({"hold", place(), *depth_m});
  const char* key = params_.lawnmower ? "lawnmower" : "waypoints";
  for (const Waypoint& point : params_.route()) {
    if (point.depth_m || point.altitude_m) depth_m = point.depth_m;
    if (depth_m) places.push_back({point.depth_m ? key : "hold", point.p_W, *depth_m});
  }
  return places;
}

void Autopilot::note_depth(const Eigen::Vector2d& p_W, double depth_m) {
  const std::string fault = sim::depth_fault(world_, p_W, depth_m);
  if (!fault.empty()) warnings_.keep_for_end(who_, "it was commanded to a position whose " + fault);
}

void Autopilot::note_start_of_route() {
  if (desired_.speed_mps == 0) warnings_.keep_for_end(who_, "it was commanded to follow a route, and had no speed");
}

double Autopilot::depth_m() const {
  return surface_m_ - body_.X_WB().translation().z();
}

Eigen::Vector2d Autopilot::place() const {
  return body_.X_WB().translation().head<2>();
}

void Autopilot::take_height(const std::optional<double>& depth_m, const std::optional<double>& altitude_m) {
  if (!depth_m && !altitude_m) return;
  altitude_desired_m_ = altitude_m;
  depth_desired_m_ = altitude_m ? std::nullopt : depth_m;
}

void Autopilot::start_route(std::vector<Waypoint> points, bool loop) {
  route_.start(std::move(points), loop, place());
  mode_ = Mode::waypoints;
  desired_.station_m.reset();
  take_waypoint();
}

void Autopilot::start_circle(const Eigen::Vector2d& center_W) {
  circle_.start(center_W, place(), sim::yaw_of(body_.X_WB().linear()));
  mode_ = Mode::circle;
  desired_.station_m.reset();
}

void Autopilot::take_waypoint() {
  take_height(route_.to().depth_m, route_.to().altitude_m);
  if (route_.to().speed_mps) desired_.speed_mps = *route_.to().speed_mps;
}

void Autopilot::set_mode(Mode mode) {
  if (mode == Mode::waypoints) {
    if (route_.size() == 0 && params_.route().empty()) throw std::runtime_error("there is no route");
    const bool own = route_.size() == 0;
    own ? start_route(params_.route(), params_.loop) : start_route(route_.points(), route_.loops());
    return note_start_of_route();
  }
  // The estimate of the disturbance belongs to the old mode.
  if (mode_ == Mode::off || mode == Mode::off) law_.reset();
  desired_.station_m.reset();
  if (mode == Mode::station) desired_.station_m = place();
  // After a time in which others drove, the depth of before is no longer wanted.
  if (mode_ == Mode::off) {
    depth_desired_m_ = depth_m();
    altitude_desired_m_.reset();
  }
  desired_.heading_rad = sim::yaw_of(body_.X_WB().linear());
  mode_ = mode;
  if (mode == Mode::circle) start_circle(place());
}

void Autopilot::set_helm(const shoal::helm_command_t& command) {
  if (mode_ == Mode::off || !std::isnan(command.heading_rad)) {
    if (mode_ != Mode::hold) set_mode(Mode::hold);
    desired_.heading_rad = given(command.heading_rad, desired_.heading_rad);
  }
  desired_.speed_mps = given(command.speed_mps, desired_.speed_mps);
  take_height(if_number(command.depth_m), if_number(command.altitude_m));
  if (command.depth_m < 0) note_depth(place(), command.depth_m);  // the bottom there may be deeper on its way
}

void Autopilot::set_waypoints(const shoal::waypoints_command_t& command) {
  std::vector<Waypoint> points(static_cast<std::size_t>(command.n));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].p_W = {command.x_m[i], command.y_m[i]};
    points[i].depth_m = if_number(command.depth_m[i]);
    if (points[i].depth_m) note_depth(points[i].p_W, *points[i].depth_m);
  }
  desired_.speed_mps = given(command.speed_mps, desired_.speed_mps);
  start_route(std::move(points), command.loop != 0);
  note_start_of_route();
}

void Autopilot::set_station(const shoal::station_command_t& command) {
  const double heading_rad = desired_.heading_rad;
  const bool kept = mode_ == Mode::station;
  set_mode(Mode::station);
  desired_.station_m = Eigen::Vector2d(given(command.x_m, place().x()), given(command.y_m, place().y()));
  desired_.heading_rad = given(command.heading_rad, kept ? heading_rad : desired_.heading_rad);
  take_height(if_number(command.depth_m), std::nullopt);
  if (!std::isnan(command.depth_m)) note_depth(*desired_.station_m, command.depth_m);
}

CraftMotion Autopilot::motion_of(const sim::World& world) const {
  CraftMotion motion;
  motion.X_WS = body_.X_WB();
  motion.v_WS_W = body_.v_WB_W();
  const sim::Matrix3d R_SW = motion.X_WS.linear().transpose();
  // The cache has no water for kinematic bodies, on which water exerts no force.
  const sim::BodyInWater& around = world.hydrodynamics().around(body_);
  const sim::Vector3d water_W =
      around.known ? around.water.velocity_W : world.medium().water_velocity_W(motion.X_WS.translation());
  motion.v_S = R_SW * (motion.v_WS_W - water_W);
  motion.w_S = R_SW * body_.w_WB_W();
  return motion;
}

/// Returns the altitude; NaN when no bottom is within range.
double Autopilot::altitude_of(const sim::SenseContext& context) const {
  const auto hit = context.world.scene().cast(body_.X_WB().translation(), -sim::Vector3d::UnitZ(),
                                              params_.altitude_range_m, {~0u, vehicle_.group()});
  return hit ? hit->range_m : nothing;
}

/// Returns the desired height; the present height when an altitude is desired and no bottom is detected.
double Autopilot::height_desired(const sim::SenseContext& context) {
  const double height_m = body_.X_WB().translation().z();
  if (!altitude_desired_m_) return surface_m_ - *depth_desired_m_;
  const double error_m = *altitude_desired_m_ - altitude_of(context);
  reading_.altitude_m = *altitude_desired_m_;
  reading_.altitude_error_m = error_m;
  return std::isnan(error_m) ? height_m : height_m + error_m;
}

void Autopilot::follow_route(double dt_s) {
  const std::size_t before = route_.index();
  const Aim aim = route_.aim(place(), body_.v_WB_W().head<2>(), sim::yaw_of(body_.X_WB().linear()), dt_s);
  if (route_.index() != before) take_waypoint();
  reading_.cross_track_m = aim.cross_track_m;
  reading_.distance_m = aim.distance_m;
  if (!route_.finished()) {
    desired_.heading_rad = aim.heading_rad;
    return;
  }
  // A craft with fins cannot stand still without losing them, so it may circle at the end.
  if (params_.at_end == AtEnd::circle) {
    start_circle(route_.to().p_W);
    return follow_circle();
  }
  mode_ = params_.at_end == AtEnd::station ? Mode::station : Mode::hold;
  if (params_.at_end == AtEnd::station) desired_.station_m = route_.to().p_W;
  if (params_.at_end == AtEnd::stop) desired_.speed_mps = 0;
}

/// Corrects the heading by the present drift angle, so that the course over ground follows the circle despite current
/// and sideslip.
void Autopilot::follow_circle() {
  const Aim aim = circle_.aim(place());
  reading_.cross_track_m = aim.cross_track_m;
  reading_.distance_m = aim.distance_m;
  const Eigen::Vector2d v_WS_W = body_.v_WB_W().head<2>();
  constexpr double slow_mps = 0.1, max_drift_rad = 1;
  const double drift_rad =
      v_WS_W.norm() < slow_mps
          ? 0
          : sim::wrap_angle(std::atan2(v_WS_W.y(), v_WS_W.x()) - sim::yaw_of(body_.X_WB().linear()));
  desired_.heading_rad = sim::wrap_angle(aim.heading_rad - std::clamp(drift_rad, -max_drift_rad, max_drift_rad));
}

void Autopilot::measure(const sim::SenseContext& context) {
  const bool driving = mode_ != Mode::off && !vehicle_.systems().estopped && !faults_.silent();
  // NaN stands for what this mode does not control.
  reading_ = {mode_, nothing, nothing, nothing, nothing, nothing, nothing, nothing, nothing, nothing, nothing, false};
  if (!driving) {
    // An integral that grows while something else drives would jump at the next start.
    law_.reset();
    given_ = {};
    return;
  }
  if (mode_ == Mode::waypoints)
    follow_route(context.dt_s);
  else if (mode_ == Mode::circle)
    follow_circle();
  desired_.height_m = height_desired(context);
  drive(context, law_.step(motion_of(context.world), desired_, context.dt_s, given_.wrench));
}

void Autopilot::drive(const sim::SenseContext& context, const Demand& demand) {
  reading_.mode = mode_;
  reading_.speed_mps = demand.speed_mps;
  reading_.heading_rad = demand.heading_rad;
  reading_.speed_error_mps = demand.speed_error_mps;
  reading_.heading_error_rad = demand.heading_error_rad;
  reading_.depth_m = or_nothing(depth_desired_m_);
  if (depth_desired_m_) reading_.depth_error_m = *depth_desired_m_ - depth_m();
  if (desired_.station_m) reading_.distance_m = (*desired_.station_m - place()).norm();
  if (!actuators_) return drive_helm(demand, context.now);
  const CraftMotion motion = motion_of(context.world);
  // Forces are shared for the water at the vehicle: a propeller gives thrust in proportion to the density.
  given_ = actuators_->share(demand.wrench, motion.v_S, context.world.hydrodynamics().water_at(body_).density_kgpm3);
  reading_.saturated = given_.saturated;
  actuators_->publish(context.now);
}

void Autopilot::drive_helm(const Demand& demand, sim::Time now) {
  shoal::helm_command_t message{};
  message.utime = world_.epoch_us() + vehicle_.clock().reading(now).count();
  message.speed_mps = demand.speed_mps;
  message.heading_rad = demand.heading_rad;
  message.depth_m = surface_m_ - desired_.height_m;
  message.altitude_m = nothing;
  if (!helm_channel_)
    helm_channel_ = vehicle_.bus().open_channel(vehicle_.find_device(params_.helm)->command_channel());
  helm_channel_->publish(shoal::encode(message), now);
}

bool Autopilot::needs_bottom() const {
  if (params_.hold.altitude_m) return true;
  const std::vector<Waypoint> points = params_.route();
  return std::any_of(points.begin(), points.end(), [](const Waypoint& point) { return point.altitude_m.has_value(); });
}

void Autopilot::Reading::visit_state(sim::StateArchive& archive) {
  archive.not_only_finite(mode, speed_mps, heading_rad, depth_m, altitude_m, speed_error_mps, heading_error_rad,
                          depth_error_m, altitude_error_m, cross_track_m, distance_m, saturated);
}

void Autopilot::visit_state(sim::StateArchive& archive) {
  archive(law_, route_, circle_, mode_, desired_, depth_desired_m_, altitude_desired_m_, given_, reading_);
  if (!archive.restoring()) return;
  if (mode_ < Mode::off || mode_ > Mode::circle) archive.fail("unknown autopilot mode");
  if (mode_ == Mode::waypoints && route_.size() == 0) archive.fail("an autopilot follows a route without waypoints");
  if (!depth_desired_m_ && !altitude_desired_m_) archive.fail("an autopilot holds neither depth nor altitude");
}

void fill(const Autopilot& autopilot, shoal::autopilot_state_t& message) {
  const Autopilot::Reading& reading = autopilot.reading();
  message.mode = static_cast<std::int8_t>(reading.mode);
  message.speed_mps = reading.speed_mps;
  message.heading_rad = reading.heading_rad;
  message.depth_m = reading.depth_m;
  message.altitude_m = reading.altitude_m;
  message.speed_error_mps = reading.speed_error_mps;
  message.heading_error_rad = reading.heading_error_rad;
  message.depth_error_m = reading.depth_error_m;
  message.altitude_error_m = reading.altitude_error_m;
  message.cross_track_m = reading.cross_track_m;
  message.distance_m = reading.distance_m;
  message.waypoint = static_cast<std::int32_t>(autopilot.route().index());
  message.waypoints = static_cast<std::int32_t>(autopilot.route().size());
  message.finished = autopilot.route().finished();
  message.saturated = reading.saturated;
}

namespace {

/// Throws when a field is outside its limits.  NaN is valid and means no change.
void check(const char* field, double value, double low, double high) {
  if (!std::isnan(value) && !(value >= low && value <= high))
    throw std::runtime_error(std::string("field '") + field + "' must be between " + sim::number_text(low) + " and " +
                             sim::number_text(high) + ", got " + sim::number_text(value));
}

constexpr double far_m = 1e7;

void take_helm(Autopilot& autopilot, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::helm_command_t>(payload, shoal::Finite::any);
  check("speed_mps", command.speed_mps, -100, 100);
  check("heading_rad", command.heading_rad, -1e3, 1e3);
  check("depth_m", command.depth_m, -far_m, far_m);
  check("altitude_m", command.altitude_m, 0, far_m);
  if (!std::isnan(command.depth_m) && !std::isnan(command.altitude_m))
    throw std::runtime_error("give depth_m or altitude_m, the other as NaN; got both");
  autopilot.set_helm(command);
}

void take_waypoints(Autopilot& autopilot, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::waypoints_command_t>(payload, shoal::Finite::any);
  if (command.n < 1) throw std::runtime_error("field 'n' must be at least 1, got " + std::to_string(command.n));
  check("speed_mps", command.speed_mps, 0, 100);
  for (std::size_t i = 0; i < command.x_m.size(); ++i) {
    // NaN means 'as before' in depth and speed, but a waypoint without a place is none.
    if (std::isnan(command.x_m[i]) || std::isnan(command.y_m[i]))
      throw std::runtime_error("a waypoint must have x_m and y_m");
    check("x_m", command.x_m[i], -far_m, far_m);
    check("y_m", command.y_m[i], -far_m, far_m);
    check("depth_m", command.depth_m[i], -far_m, far_m);
  }
  autopilot.set_waypoints(command);
}

void take_station(Autopilot& autopilot, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::station_command_t>(payload, shoal::Finite::any);
  check("x_m", command.x_m, -far_m, far_m);
  check("y_m", command.y_m, -far_m, far_m);
  check("depth_m", command.depth_m, -far_m, far_m);
  check("heading_rad", command.heading_rad, -1e3, 1e3);
  autopilot.set_station(command);
}

}  // namespace

void AutopilotController::receive(sim::Time, std::span<const std::byte> payload) {
  const std::int64_t type = shoal::fingerprint(payload);
  if (type == shoal::fingerprint_of<shoal::waypoints_command_t>()) return take_waypoints(autopilot_, payload);
  if (type == shoal::fingerprint_of<shoal::station_command_t>()) return take_station(autopilot_, payload);
  if (type == shoal::fingerprint_of<shoal::helm_command_t>()) return take_helm(autopilot_, payload);
  const auto command = shoal::decode<shoal::autopilot_command_t>(payload, shoal::Finite::required);
  if (command.mode < 0 || command.mode > 4)
    throw std::runtime_error("field 'mode' must be 0 to 4, got " + std::to_string(command.mode));
  autopilot_.set_mode(static_cast<Autopilot::Mode>(command.mode));
}

SHOAL_TRANSCEIVER("autopilot", Autopilot, shoal::autopilot_state_t, AutopilotController);

}  // namespace devices
