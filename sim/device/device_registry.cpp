#include "sim/device/device_registry.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/world/vehicle.hpp"

namespace sim {

Joint& DeviceContext::joint(const std::string& name) const {
  return vehicle.joint(name);
}

std::string DeviceContext::full_name() const {
  return vehicle.name() + "/" + config.name;
}

DeviceRegistry& DeviceRegistry::instance() {
  static DeviceRegistry registry;
  return registry;
}

void DeviceRegistry::add(DeviceType type) {
  if (find(type.name) != nullptr) throw std::logic_error("device type '" + type.name + "' exists twice");
  const auto at = std::lower_bound(types_.begin(), types_.end(), type.name,
                                   [](const auto& other, const std::string& name) { return other->name < name; });
  types_.insert(at, std::make_unique<DeviceType>(std::move(type)));
}

const DeviceType* DeviceRegistry::find(const std::string& name) const {
  for (const auto& type : types_)
    if (type->name == name) return type.get();
  return nullptr;
}

std::vector<const DeviceType*> DeviceRegistry::all() const {
  std::vector<const DeviceType*> all;
  for (const auto& type : types_) all.push_back(type.get());
  return all;
}

}  // namespace sim
