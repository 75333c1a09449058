// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/config_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/base/math.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

namespace {

/// Tolerance for the rounding of step_s * rate_hz.
constexpr double close_to_one = 1 + 1e-9;

class ConfigCheck {
 public:
  ConfigCheck(const WorldConfig& world, const ConfigNode& root, Warnings& warnings, double end_s)
      : world_(world), root_(root), warnings_(warnings), end_s_(end_s) {}

  void check_water() const {
    if (!world_.medium.water) return;
    for (const std::string& warning : world_.medium.water->warnings)
      warnings_.warn(world_.medium.water->place, "medium: water", warning);
  }

  void check_vehicles() const {
    std::set<const VehicleConfig*> seen;  // for look-ups, never iterated
    for (const VehicleInstance& vehicle : world_.vehicles) {
      if (!seen.insert(vehicle.config.get()).second) continue;
      const std::string who = "vehicle '" + vehicle.name + "': ";
      for (const DeviceConfig& device : vehicle.config->devices)
        check_device(device, who + "device '" + device.name + "'");
      check_mechanism(*vehicle.config, vehicle.config->source.get(), who);
    }
  }

  void check_objects() const {
    for (const ObjectConfig& object : world_.objects) check_object(object, "");
    for (const EventConfig& event : world_.events)
      for (const ActionEntry& entry : event.actions) {
        std::vector<const ObjectConfig*> added;
        if (entry.action) entry.action->add_objects(added);
        for (const ObjectConfig* object : added) check_object(*object, entry.who + ": ");
      }
  }

  /// Places such as those of a map in UTM.  The world is a plane that touches the earth at its origin: 150 km away it
  /// is 1.8 km above the ellipsoid.  In UTM x is 166 km or more.
  void check_places() const {
    constexpr double far_m = 150e3;
    const SourcePlace* place = nullptr;
    std::string who;
    double distance_m = 0;
    int others = -1;
    const auto check = [&](const Vector3d& p, const SourcePlace& source, const char* kind, const std::string& name) {
      const double distance = p.head<2>().norm();
      if (distance < far_m || others++ >= 0) return;
      place = &source;
      who = std::string(kind) + " '" + name + "'";
      distance_m = distance;
    };
    for (const VehicleInstance& vehicle : world_.vehicles)
      check(vehicle.X_WV.translation(), vehicle.place, "vehicle", vehicle.name);
    for (const ObjectConfig& object : world_.objects) check(object.position_m, object.place, "object", object.name);
    if (place == nullptr) return;
    const std::string more = others == 0 ? "" : ", and " + std::to_string(others) + " more are as far";
    warnings_.warn(*place, who,
                   "it is " + std::to_string(std::lround(distance_m / 1000)) + " km from the world's origin" + more +
                       ": the world is flat, so that a GPS there is far above the earth; give coordinates of a map, "
                       "such as UTM, relative to 'origin'");
  }

  void check_rates() const {
    if (root_.find("state_rate_hz") != nullptr)
      check_rate("'state_rate_hz'", world_.state_rate_hz, place_of(root_, "state_rate_hz"), "");
    const ConfigNode* run = root_.find("run");
    if (run != nullptr && run->find("track_rate_hz") != nullptr)
      check_rate("'track_rate_hz'", world_.run.track_rate_hz, place_of(*run, "track_rate_hz"), "run");
  }

  void check_metrics() const {
    const std::set<std::string> spoken = channels_of(world_);
    for (const MetricConfig& metric : world_.metrics) {
      if (!metric.params) continue;
      const std::string who = "metric '" + metric.name + "'";
      const MetricParams& params = *metric.params;
      if (end_s_ > 0 && params.from_s >= end_s_)
        warnings_.warn(metric.place, who,
                       "'from_s' " + number_text(params.from_s) + " is not before the end of the run at " +
                           number_text(end_s_) + " s: nothing counts");
      // The publications of programs are unknown here.
      if (params.channel.empty() || !world_.processes.empty()) continue;
      if (spoken.contains(params.channel) || params.channel.starts_with("sim.")) continue;
      warnings_.warn(metric.place, who,
                     "nothing in this world publishes on '" + params.channel + "'" + truth_hint(params.channel) +
                         ", and it starts no programs: only one started by hand can");
    }
  }

  void check_events() const {
    std::set<std::string> triggered;
    for (const EventConfig& event : world_.events)
      for (const ActionEntry& entry : event.actions)
        if (entry.action) entry.action->add_triggered(triggered);
    for (const EventConfig& event : world_.events) {
      if (!event.fires_by_itself() && !triggered.contains(event.name))
        warnings_.warn(
            event.place, "event '" + event.name + "'",
            "it has no 'at', 'every' or 'when', and no event triggers it: only a request can fire it, `shoal control "
            "do`");
      const bool late = !event.at_s.empty() &&
                        std::all_of(event.at_s.begin(), event.at_s.end(), [&](double at_s) { return at_s > end_s_; });
      if (end_s_ > 0 && late)
        warnings_.warn(event.place, "event '" + event.name + "'",
                       "it fires at " + number_text(*std::min_element(event.at_s.begin(), event.at_s.end())) +
                           " s, but the run ends at " + number_text(end_s_) + " s");
    }
  }

  /// Spreading that has no effect.  Spherical spreading is what it becomes.
  void check_spreading() const {
    const ConfigNode* acoustics = root_.find("acoustics");
    if (acoustics == nullptr || acoustics->find("spreading") == nullptr || !world_.medium.water) return;
    const WaterConfig& water = *world_.medium.water;
    const bool has_profile = water.profile.size() > 1 && !water.sound_speed_mps;
    if (sound_paths(world_.acoustics, has_profile) != SoundPaths::rays) return;
    const SpreadingConfig& spreading = world_.acoustics.spreading;
    if (!spreading.transition_range_m && spreading.factor == 2) return;
    warnings_.warn(place_of(*acoustics, "spreading"), "acoustics",
                   "'spreading' has no effect: in this water sound travels along rays, whose ray tubes give the "
                   "spreading; remove it, or set 'propagation: straight'");
  }

 private:
  void check_object(const ObjectConfig& object, const std::string& where) const {
    check_mechanism(object, object.source.get(), where + "object '" + object.name + "': ");
  }

  /// Those of coefficients are found when the world is built.
  void check_mechanism(const MechanismConfig& config, const ConfigNode* source, const std::string& who) const {
    for (const BodyConfig& body : config.bodies) check_body(body, who + "body '" + body.name + "'");
    const ConfigNode* joints = source != nullptr ? source->find("joints") : nullptr;
    for (std::size_t i = 0; joints != nullptr && i < config.joints.size(); ++i)
      check_joint(config.joints[i], joints->items[i], who);
    for (const BodyConfig* body : config.unconnected())
      if (!body->kinematic)
        warnings_.warn(body->place, who + "body '" + body->name + "'",
                       "no joints connect it with body '" + config.bodies.front().name + "': it moves on its own");
  }

  void check_body(const BodyConfig& body, const std::string& who) const {
    const auto& config = body.hydrodynamics;
    if (!config || config->model == HydrodynamicsConfig::Model::coefficients || !(config->mass_kg > 0)) return;
    if (config->inertia_kgm2.isZero(0)) return;  // none is given
    for (const std::string& doubt : doubts_about_inertia(*config)) warnings_.warn(config->place, who, doubt);
  }

  void check_device(const DeviceConfig& device, const std::string& who) const {
    if (device.device_type == nullptr) return;
    for (const std::string& key : device.device_type->without_effect)
      if (device.source && device.source->find(key) != nullptr)
        warnings_.warn(place_of(*device.source, key), who,
                       "'" + key + "' has no effect on a device of type '" + device.type + "'");
    check_noise(device, who);
    const auto place = [&](const char* key) { return device.source ? place_of(*device.source, key) : device.place; };
    if (device.device_type->reports()) {
      const bool given = device.source && device.source->find("rate_hz") != nullptr;
      check_rate(given ? "'rate_hz'" : "its default rate", device.rate_hz, place("rate_hz"), who);
      return;
    }
    for (const char* key : {"rate_hz", "phase_s", "truth", "channel"})
      if (device.source && device.source->find(key) != nullptr)
        warnings_.warn(
            place(key), who,
            "'" + std::string(key) + "' has no effect: a device of type '" + device.type + "' publishes no reports");
  }

  /// Errors of angles are in radians, and their keys do not say so.
  void check_noise(const DeviceConfig& device, const std::string& who) const {
    for (const char* of : {"heading_noise", "tilt_noise", "bearing_noise", "azimuth_noise", "elevation_noise"}) {
      const ConfigNode* noise = device.source ? device.source->find(of) : nullptr;
      for (const char* key : {"bias", "bias_std", "gauss_markov_std", "gaussian_std"}) {
        const ConfigNode* value = noise != nullptr ? noise->find(key) : nullptr;
        const double error_rad = value != nullptr ? std::abs(read_number(value->scalar).value_or(0)) : 0;
        if (error_rad > 1)
          warnings_.warn(value->place, who,
                         "'" + std::string(key) + "' of '" + of + "' is in radians, and " + value->scalar +
                             " of them are " + number_text(std::round(radians_to_degrees(error_rad))) + " degrees");
      }
    }
  }

  void check_joint(const JointConfig& joint, const ConfigNode& source, const std::string& who) const {
    // Keys without effect are often the sign of a wrong `type`: the joint is valid, but moves otherwise than its
    // author thinks.
    const bool fixed = joint.type == JointType::fixed, ball = joint.type == JointType::ball;
    const std::string type = std::string(word_of(joint_type_words, joint.type)) + (fixed ? " joint" : "");
    const auto warn_of = [&](const ConfigNode* axis, std::initializer_list<const char*> keys,
                             const std::string& where) {
      for (const char* key : keys)
        if (axis != nullptr && axis->find(key) != nullptr)
          warnings_.warn(place_of(*axis, key), who + "joint '" + joint.name + "'",
                         "'" + std::string(key) + "' has no effect on a " + type + where);
    };
    const auto stop_keys = {"low_stop", "high_stop", "restitution", "stop_erp", "stop_cfm", "fudge_factor"};
    const auto motor_keys = {"motor_velocity", "motor_max_force", "cfm", "damping"};
    const auto suspension_keys = {"suspension_erp", "suspension_cfm"};
    warn_of(&source, {fixed || ball ? "axis" : "erp"}, "");
    if (fixed || (ball && !joint.motor)) {
      const std::string where = fixed ? "" : " without 'motor: true'";
      warn_of(&source, stop_keys, where);
      warn_of(&source, motor_keys, where);
    }
    if (joint.type != JointType::hinge2) warn_of(&source, suspension_keys, "");
    const ConfigNode* axis2 = source.find("axis2");
    warn_of(axis2, {"erp"}, "");
    warn_of(axis2, suspension_keys, "'s second axis");
    if (joint.type == JointType::hinge2) warn_of(axis2, stop_keys, "'s second axis");
  }

  void check_rate(const std::string& what, double rate_hz, const SourcePlace& place, const std::string& who) const {
    const double step_s = world_.physics.step_s;
    if (rate_hz * step_s <= close_to_one) return;
    warnings_.warn(place, who,
                   what + " of " + number_text(rate_hz) + " Hz is above the step rate: it becomes " +
                       number_text(std::round(1e6 / step_s) / 1e6) + " Hz with 'step_s' " + number_text(step_s));
  }

  /// Returns a hint for a channel on which a device would publish if it were configured to.
  std::string truth_hint(const std::string& channel) const {
    for (const VehicleInstance& vehicle : world_.vehicles)
      for (const DeviceConfig& device : vehicle.config->devices)
        if (device.device_type != nullptr && device.device_type->reports() &&
            device_channel(world_.channels, vehicle.name, device, ChannelKind::truth) == channel)
          return " (device '" + device.name + "' needs 'truth: true')";
    return "";
  }

  const WorldConfig& world_;
  const ConfigNode& root_;
  Warnings& warnings_;
  double end_s_;  ///< 0: unlimited run
};

}  // namespace

std::set<std::string> channels_of(const WorldConfig& world) {
  std::set<std::string> channels;
  for (const VehicleInstance& vehicle : world.vehicles)
    for (const DeviceConfig& device : vehicle.config->devices) {
      if (device.device_type == nullptr || !device.device_type->reports()) continue;
      channels.insert(device_channel(world.channels, vehicle.name, device, ChannelKind::report));
      if (device.truth) channels.insert(device_channel(world.channels, vehicle.name, device, ChannelKind::truth));
    }
  for (const EventConfig& event : world.events)
    for (const ActionEntry& entry : event.actions)
      if (entry.action) entry.action->add_channels(channels);
  return channels;
}

std::set<std::string> subscribed_channels_of(const WorldConfig& world) {
  std::set<std::string> channels;
  for (const VehicleInstance& vehicle : world.vehicles)
    for (const DeviceConfig& device : vehicle.config->devices)
      if (device.device_type != nullptr && device.device_type->takes_commands())
        channels.insert(device_channel(world.channels, vehicle.name, device, ChannelKind::command));
  for (const MetricConfig& metric : world.metrics)
    if (metric.params && !metric.params->channel.empty()) channels.insert(metric.params->channel);
  for (const EventConfig& event : world.events)
    if (event.when.kind == Condition::Kind::message) channels.insert(event.when.subject);
  return channels;
}

void warn_of_config(const WorldConfig& world, const ConfigNode& root, Warnings& warnings,
                    std::optional<double> duration_s) {
  const double given_s = duration_s.value_or(world.run.duration_s);
  // A run without an end reaches every event.
  const bool endless = given_s == 0 || world.run.duration_s == 0;
  const ConfigCheck check(world, root, warnings, endless ? 0 : std::max(given_s, world.run.duration_s));
  check.check_vehicles();
  check.check_objects();
  check.check_places();
  check.check_water();
  check.check_rates();
  check.check_metrics();
  check.check_events();
  check.check_spreading();
}

}  // namespace sim
