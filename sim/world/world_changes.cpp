#include <algorithm>

#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

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
    for (const ChannelKind kind : {ChannelKind::report, ChannelKind::command, ChannelKind::truth}) {
      const std::string channel = channel_of(instance.name, device, kind);
      const std::string error = channel_error(channel, channels_.contains(channel) || !own.insert(channel).second);
      if (!error.empty()) throw_config_error(device.place, who + ": device " + quoted(device.name), error);
    }
}

const Vehicle& World::add_vehicle(const VehicleInstance& instance) {
  check_new_vehicle(instance);
  try {
    physics_->add_categories(instance.config->categories);
  } catch (const std::length_error& error) {
    throw_config_error(instance.place, "vehicle " + quoted(instance.name), error.what());
  }
  physics_->add_surfaces(instance.config->materials, instance.config->contacts);
  const Vehicle& vehicle = build_vehicle(instance);
  sort_devices();
  return vehicle;
}

void World::check_removable(const std::string& name) const {
  vehicle_named(name);
  for (const MetricConfig& metric : config_.metrics)
    if (metric.vehicle == name)
      throw WorldError("vehicle " + quoted(name) + " cannot be removed: metric '" + metric.name + "' scores it");
}

void World::remove_vehicle(const std::string& name) {
  check_removable(name);
  take_apart(vehicle_named(name));
  sort_devices();
}

void World::take_apart(Vehicle& vehicle) {
  for (MountedDevice* device : vehicle.devices()) remove_device(*device);
  physics_->remove_group(vehicle.group());
  ++generation_;
  vehicles_by_name_.erase(vehicle.name());
  std::erase_if(vehicles_, [&](const auto& other) { return other.get() == &vehicle; });
}

void World::remove_device(MountedDevice& device) {
  events_.forget_device(device.number());
  for (const ChannelKind kind : {ChannelKind::report, ChannelKind::command, ChannelKind::truth})
    channels_.erase(channel_of(device.vehicle().name(), device.config(), kind));
  const int number = device.number();
  free_numbers_.push_back(number);
  devices_[static_cast<std::size_t>(number)].reset();
}

void World::move_vehicle(const std::string& name, const Pose& X_WV) {
  const Vehicle& vehicle = vehicle_named(name);
  physics_->move_group(vehicle.group(), X_WV * vehicle.X_WV().inverse());
}

const WorldObject& World::add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) {
  const std::string who = "object " + quoted(name);
  check_new_name(name, config.place, who);
  check_limit("objects", objects_.size() + 1, config_.limits.objects, config.place, who);
  check_limit("parts in an object", config.parts.size(), config_.limits.parts, config.place, who);
  return build_object(config, name, X_WE);
}

void World::remove_object(const std::string& name) {
  const WorldObject& object = object_named(name);
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

}  // namespace sim
