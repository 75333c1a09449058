// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/entities.hpp"

#include <algorithm>
#include <utility>

#include "sim/state/state_archive.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace sim {

Vehicle* Entities::find_vehicle(const std::string& name) const {
  const auto found = vehicles_by_name_.find(name);
  return found == vehicles_by_name_.end() ? nullptr : found->second;
}

const WorldObject* Entities::find_object(const std::string& name) const {
  const auto found = objects_.find(name);
  return found == objects_.end() ? nullptr : &found->second;
}

MountedDevice* Entities::find_device(const std::string& full_name) const {
  const std::size_t slash = full_name.find('/');
  if (slash == std::string::npos) return nullptr;
  const Vehicle* vehicle = find_vehicle(full_name.substr(0, slash));
  return vehicle ? vehicle->find_device(full_name.substr(slash + 1)) : nullptr;
}

Vehicle& Entities::vehicle_named(const std::string& name) const {
  Vehicle* vehicle = find_vehicle(name);
  if (vehicle == nullptr) throw WorldError("there is no vehicle " + shown_name(name));
  return *vehicle;
}

const WorldObject& Entities::object_named(const std::string& name) const {
  const WorldObject* object = find_object(name);
  if (object == nullptr) throw WorldError("there is no object " + shown_name(name));
  return *object;
}

MountedDevice& Entities::device_named(const std::string& full_name) const {
  MountedDevice* device = find_device(full_name);
  if (device == nullptr)
    throw WorldError("there is no device " + shown_name(full_name) + "; devices are named VEHICLE/DEVICE");
  return *device;
}

void Entities::check_new_name(const std::string& name, const SourcePlace& place, const std::string& who) const {
  const char* kind = vehicles_by_name_.contains(name) ? "vehicle" : objects_.contains(name) ? "object" : nullptr;
  if (kind) throw_config_error(place, who, "there already is " + with_article(kind) + " of this name");
}

Vehicle& Entities::add(std::unique_ptr<Vehicle> vehicle) {
  vehicles_.push_back(std::move(vehicle));
  vehicles_by_name_.emplace(vehicles_.back()->name(), vehicles_.back().get());
  return *vehicles_.back();
}

const WorldObject& Entities::add(WorldObject object) {
  const std::string name = object.name;
  return objects_.insert_or_assign(name, std::move(object)).first->second;
}

void Entities::remove(const Vehicle& vehicle) {
  vehicles_by_name_.erase(vehicle.name());
  std::erase_if(vehicles_, [&](const auto& other) { return other.get() == &vehicle; });
}

void Entities::remove(const WorldObject& object) {
  objects_.erase(object.name);
}

void Entities::clear() {
  vehicles_by_name_.clear();
  vehicles_.clear();
  objects_.clear();
  next_vehicle_number_ = 0;
  next_object_number_ = 0;
}

void Entities::visit_state(StateArchive& archive) {
  archive(next_vehicle_number_, next_object_number_);
  constexpr int max_vehicles_ever = 100'000'000;  // some lists have an element for each number
  if (archive.restoring() &&
      (next_vehicle_number_ < 0 || next_vehicle_number_ > max_vehicles_ever || next_object_number_ < 0))
    archive.fail("invalid numbers of vehicles or objects");
}

}  // namespace sim
