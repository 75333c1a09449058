// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/surfaces.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/physics/physics_world.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

void Surfaces::start(const WorldConfig& config) {
  materials_ = {"default"};
  for (const MaterialConfig& material : config.materials) materials_.insert(material.name);
  contacts_ = config.contacts;
}

bool Surfaces::has_new(const VehicleConfig& config) const {
  const auto new_category = [&](const std::string& name) {
    try {
      physics_.category_bit(name);
      return false;
    } catch (const std::out_of_range&) {
      return true;
    }
  };
  const auto new_material = [&](const MaterialConfig& each) { return !materials_.contains(each.name); };
  const auto new_contact = [&](const ContactConfig& each) {
    return std::find(contacts_.begin(), contacts_.end(), each) == contacts_.end();
  };
  return std::any_of(config.categories.begin(), config.categories.end(), new_category) ||
         std::any_of(config.materials.begin(), config.materials.end(), new_material) ||
         std::any_of(config.contacts.begin(), config.contacts.end(), new_contact);
}

/// Checks that a new vehicle defines only its own surfaces: a contact of [default, any] would change those of others.
void Surfaces::check_new(const VehicleInstance& instance) const {
  const std::string who = "vehicle " + shown_name(instance.name);
  const VehicleConfig& config = *instance.config;
  std::set<std::string, std::less<>> own;
  for (const MaterialConfig& material : config.materials)
    if (!materials_.contains(material.name)) own.insert(material.name);
  constexpr int max_materials = 200;  // limits the size of the table of pairs
  check_limit("materials", materials_.size() + own.size(), max_materials, instance.place, who);
  check_limit("contacts", contacts_.size() + config.contacts.size(), 20 * max_materials, instance.place, who);
  for (const ContactConfig& contact : config.contacts) {
    const bool known = std::find(contacts_.begin(), contacts_.end(), contact) != contacts_.end();
    if (!known && !own.contains(contact.between[0]) && !own.contains(contact.between[1]))
      throw_config_error(instance.place, who,
                         "its contact between '" + contact.between[0] + "' and '" + contact.between[1] +
                             "' would change the surfaces of others: it must name a new material");
  }
}

void Surfaces::add(const VehicleConfig& config) {
  physics_.add_categories(config.categories);
  physics_.add_surfaces(config.materials, config.contacts);
  for (const MaterialConfig& material : config.materials) materials_.insert(material.name);
  for (const ContactConfig& contact : config.contacts)
    if (std::find(contacts_.begin(), contacts_.end(), contact) == contacts_.end()) contacts_.push_back(contact);
}

}  // namespace sim
