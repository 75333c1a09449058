// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "sim/acoustics/channel.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/bottom_check.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world/world_warnings.hpp"
#include "sim/world_file/device_change.hpp"

// What changes a world while it runs.

namespace sim {

namespace {

std::string quoted(const std::string& name) {
  return "'" + shortened(printable(name)) + "'";
}

}  // namespace

Vehicle& World::vehicle_named(const std::string& name) const {
  const auto found = vehicles_by_name_.find(name);
  if (found == vehicles_by_name_.end()) throw WorldError("there is no vehicle " + quoted(name));
  return *found->second;
}

const WorldObject& World::object_named(const std::string& name) const {
  const WorldObject* object = find_object(name);
  if (object == nullptr) throw WorldError("there is no object " + quoted(name));
  return *object;
}

MountedDevice& World::device_named(const std::string& name) const {
  MountedDevice* device = find_device(name);
  if (device == nullptr) throw WorldError("there is no device " + quoted(name) + "; devices are named VEHICLE/DEVICE");
  return *device;
}

void World::check_new_name(const std::string& name, const SourcePlace& place, const std::string& who) const {
  const char* kind = vehicles_by_name_.contains(name) ? "vehicle" : objects_.contains(name) ? "object" : nullptr;
  if (kind) throw_config_error(place, who, "there is " + with_article(kind) + " of this name already");
}

namespace {

void check_limit(const char* what, std::size_t count, int limit, const SourcePlace& place, const std::string& who) {
  if (count > static_cast<std::size_t>(limit))
    throw_config_error(place, who,
                       "at most " + std::to_string(limit) + " " + what + " are allowed (limits of the world), got " +
                           std::to_string(count));
}

}  // namespace

void World::check_new_vehicle(const VehicleInstance& instance) const {
  const std::string who = "vehicle " + quoted(instance.name);
  check_new_name(instance.name, instance.place, who);
  const VehicleConfig& config = *instance.config;
  const LimitsConfig& limits = config_.limits;
  check_limit("vehicles", vehicles_.size() + 1, limits.vehicles, instance.place, who);
  check_limit("bodies in a vehicle", config.bodies.size(), limits.bodies_per_vehicle, instance.place, who);
  check_limit("devices in a vehicle", config.devices.size(), limits.devices_per_vehicle, instance.place, who);
  std::size_t parts = 0;
  for (const BodyConfig& body : config.bodies) parts += body.parts.size();
  check_limit("parts in a vehicle", parts, limits.parts, instance.place, who);
  std::set<std::string, std::less<>> own;
  for (const DeviceConfig& device : config.devices)
    for (const ChannelKind kind : all_channel_kinds) {
      const std::string channel = device_channel(config_.channels, instance.name, device, kind);
      const std::string error = channel_error(channel, channels_.contains(channel) || !own.insert(channel).second);
      if (!error.empty()) throw_config_error(device.place, who + ": device " + quoted(device.name), error);
    }
}

/// What a newcomer says of surfaces may concern its own only: a contact of [default, any] would change everybody's.
void World::check_new_surfaces(const VehicleInstance& instance) const {
  const std::string who = "vehicle " + quoted(instance.name);
  const VehicleConfig& config = *instance.config;
  std::set<std::string, std::less<>> own;
  for (const MaterialConfig& material : config.materials)
    if (!known_materials_.contains(material.name)) own.insert(material.name);
  constexpr int most_materials = 200;  // a table of pairs is kept
  check_limit("materials", known_materials_.size() + own.size(), most_materials, instance.place, who);
  check_limit("contacts", known_contacts_.size() + config.contacts.size(), 20 * most_materials, instance.place, who);
  for (const ContactConfig& contact : config.contacts) {
    const bool known = std::find(known_contacts_.begin(), known_contacts_.end(), contact) != known_contacts_.end();
    if (!known && !own.contains(contact.between[0]) && !own.contains(contact.between[1]))
      throw_config_error(instance.place, who,
                         "its contact between '" + contact.between[0] + "' and '" + contact.between[1] +
                             "' would change the surfaces of others: it must name a new material of its own");
  }
}

void World::check_place_is_free(Vehicle& vehicle, const SourcePlace& place) {
  constexpr double allowed_m = 0.05;
  const auto [other, depth_m] = physics_->deepest_overlap(vehicle.group());
  if (depth_m <= allowed_m) return;
  const std::string who = "vehicle " + quoted(vehicle.name());
  take_apart(vehicle);
  throw_config_error(place, who,
                     "'position_m' is taken: it would stand " + number_text(std::round(depth_m * 1000) / 1000) +
                         " m deep in '" + other + "'");
}

void World::bring_surfaces(const VehicleConfig& config) {
  physics_->add_categories(config.categories);
  physics_->add_surfaces(config.materials, config.contacts);
  for (const MaterialConfig& material : config.materials) known_materials_.insert(material.name);
  for (const ContactConfig& contact : config.contacts)
    if (std::find(known_contacts_.begin(), known_contacts_.end(), contact) == known_contacts_.end())
      known_contacts_.push_back(contact);
}

const Vehicle& World::add_vehicle(const VehicleInstance& instance) {
  check_new_vehicle(instance);
  check_new_surfaces(instance);
  const bool new_surfaces = journal_->has_new_surfaces(*instance.config);
  try {
    physics_->add_categories(instance.config->categories);
  } catch (const std::length_error& error) {
    throw_config_error(instance.place, "vehicle " + quoted(instance.name), error.what());
  }
  bring_surfaces(*instance.config);
  const int number = next_vehicle_number_;
  try {
    check_place_is_free(build_vehicle(instance), instance.place);
  } catch (...) {
    journal_->vehicle_failed(instance, new_surfaces);
    throw;
  }
  journal_->vehicle_came(instance, number, new_surfaces);
  const Vehicle& vehicle = *vehicles_.back();
  for (const std::vector<std::string>& found : {hydrodynamics_->take_warnings(), bottom_warnings(*this, vehicle)})
    for (const std::string& warning : found) warnings_of(*this).warn({}, "", warning);
  sort_devices();
  return vehicle;
}

void World::check_removable(const std::string& name) const {
  vehicle_named(name);
  for (const MetricConfig& metric : config_.metrics)
    if (metric.params && metric.params->vehicle == name)
      throw WorldError("vehicle " + quoted(name) + " cannot be removed: metric '" + metric.name + "' scores it");
}

void World::remove_vehicle(const std::string& name) {
  check_removable(name);
  Vehicle& vehicle = vehicle_named(name);
  const std::string own_name = vehicle.name();  // the caller's may be that of the vehicle
  take_apart(vehicle);
  journal_->vehicle_went(own_name);
  sort_devices();
}

void World::take_apart(Vehicle& vehicle) {
  for (MountedDevice* device : vehicle.devices()) remove_device(*device);
  hydrodynamics_->remove_group(vehicle.group());
  physics_->remove_group(vehicle.group());
  ++generation_;
  vehicles_by_name_.erase(vehicle.name());
  std::erase_if(vehicles_, [&](const auto& other) { return other.get() == &vehicle; });
}

void World::remove_device(MountedDevice& device) {
  events_.forget_device(device.number());
  for (const ChannelKind kind : all_channel_kinds)
    channels_.erase(device_channel(config_.channels, device.vehicle().name(), device.config(), kind));
  const int number = device.number();
  free_numbers_.push_back(number);
  devices_[static_cast<std::size_t>(number)].reset();
}

void World::move_vehicle(const std::string& name, const Pose& X_WV) {
  const Vehicle& vehicle = vehicle_named(name);
  const Pose X_move_W = X_WV * vehicle.X_WV().inverse();
  physics_->move_group(vehicle.group(), X_move_W);
  if (physics_->anchored(vehicle.group())) journal_->anchored_vehicle_moved(vehicle);
  acoustics_->forget_places();
}

const WorldObject& World::add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) {
  const std::string who = "object " + quoted(name);
  check_new_name(name, config.place, who);
  check_limit("objects", objects_.size() + 1, config_.limits.objects, config.place, who);
  check_limit("parts in an object", config.parts.size(), config_.limits.parts, config.place, who);
  const WorldObject& object = place_object(config, name, X_WE);
  journal_->object_came(config, object, X_WE);
  return object;
}

const WorldObject& World::place_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) {
  // What an actor leads along must be kinematic, also when something else of its name comes.
  const bool led = std::any_of(config_.actors.begin(), config_.actors.end(),
                               [&](const ActorConfig& actor) { return actor.object == name; });
  if (!led || config.kinematic) return build_object(config, name, X_WE);
  const bool has_plane = std::any_of(config.parts.begin(), config.parts.end(),
                                     [](const PartConfig& part) { return part.shape == PartShape::plane; });
  if (config.fixed || has_plane)
    throw_config_error(config.place, "object " + quoted(name), "an actor moves it: it cannot be fixed or a plane");
  ObjectConfig kinematic = config;
  kinematic.kinematic = true;
  return build_object(kinematic, name, X_WE);
}

void World::remove_object(const std::string& name) {
  const WorldObject& object = object_named(name);
  const std::string own_name = object.name;  // the caller's may be that of the object
  take_apart(object);
  journal_->object_went(own_name);
}

void World::take_apart(const WorldObject& object) {
  hydrodynamics_->remove_group(object.group);
  physics_->remove_group(object.group);
  ++generation_;
  objects_.erase(object.name);
}

void World::move_object(const std::string& name, const Pose& X_WE) {
  const WorldObject& object = object_named(name);
  object.body->set_pose(X_WE);
  object.body->set_velocity_W(Vector3d::Zero(), Vector3d::Zero());
}

void World::set_fault(const std::string& device, const FaultConfig& fault) {
  MountedDevice& mounted = device_named(device);
  const std::string error = fault_misfit(*mounted.config().device_type, fault);
  if (!error.empty()) throw WorldError("device " + quoted(device) + ": " + error);
  mounted.set_fault(fault);
}

void World::clear_faults(const std::string& device) {
  device_named(device).clear_faults();
}

bool World::change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) {
  const bool changed = apply_change(full_name, values, diagnostics);
  if (changed) journal_->device_changed(full_name, values);
  return changed;
}

bool World::apply_change(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) {
  MountedDevice* device = find_device(full_name);
  const std::string who = "device '" + shortened(printable(full_name)) + "'";
  if (device == nullptr) {
    diagnostics.error(values.place, who, "there is no such device; devices are named VEHICLE/DEVICE");
    return false;
  }
  const auto changed = changed_device(device->config(), device->vehicle().config(), config_, values, who, diagnostics);
  if (changed) device->change(*changed, now());
  for (Sensing& sensing : sensing_)
    if (sensing.device == device) sensing.due_step = device->next_sample_step();
  return changed.has_value();
}

}  // namespace sim
