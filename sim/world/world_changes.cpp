#include <algorithm>

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
