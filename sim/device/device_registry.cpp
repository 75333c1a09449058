// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/device_registry.hpp"

#include <algorithm>
#include <utility>

#include "sim/config/message_text.hpp"

namespace sim {

std::string quantity_of(const std::string& noise_key) {
  constexpr std::string_view suffix = "_noise";
  return noise_key.ends_with(suffix) ? noise_key.substr(0, noise_key.size() - suffix.size()) : noise_key;
}

std::vector<std::string> DeviceType::quantities() const {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  make_params()->read(in);
  std::vector<std::string> names;
  for (const ParamInfo& info : table)
    if (std::any_of(info.children.begin(), info.children.end(),
                    [](const ParamInfo& child) { return child.key == "gaussian_std"; }))
      names.push_back(quantity_of(info.key));
  return names;
}

std::string fault_misfit(const DeviceType& type, const FaultConfig& fault) {
  const bool of_actuator = fault.kind == FaultKind::partial || fault.kind == FaultKind::dead;
  if (of_actuator && !type.is_actuator()) return "a " + type.name + " is not an actuator: it cannot be dead or partial";
  const bool of_quantity = fault.kind == FaultKind::biased || !fault.quantity.empty();
  if (!of_quantity) return {};
  const std::vector<std::string> known = type.quantities();
  if (known.empty()) return "a " + type.name + " has no quantity with an error that could be biased or degraded";
  if (fault.quantity.empty() || std::find(known.begin(), known.end(), fault.quantity) != known.end()) return {};
  return "a " + type.name + " has no quantity '" + fault.quantity + "'; known quantities: " + list_text(known);
}

DeviceRegistry& DeviceRegistry::instance() {
  static DeviceRegistry registry;
  return registry;
}

void DeviceRegistry::add(DeviceType type) {
  if (find(type.name) != nullptr) {
    problems_.push_back("device type '" + type.name + "' exists twice");
    return;
  }
  const auto at = std::lower_bound(types_.begin(), types_.end(), type.name,
                                   [](const auto& other, const std::string& name) { return other->name < name; });
  types_.insert(at, std::make_unique<DeviceType>(std::move(type)));
}

std::vector<std::string> DeviceRegistry::take_problems() {
  return std::exchange(problems_, {});
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
