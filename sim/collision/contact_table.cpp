// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/contact_table.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace sim {
namespace {

Surface make_surface(const ContactConfig& config) {
  Surface surface;
  dSurfaceParameters& p = surface.parameters;
  // Approx1: mu is a friction coefficient; otherwise it would be a force in newtons.
  p.mode = dContactApprox1;
  p.mu = p.mu2 = config.friction;
  surface.friction = config.friction > 0;
  if (surface.friction) surface.rows += 2;
  // Optional restitution, softness, rolling friction and slip.
  if (config.restitution > 0) {
    p.mode |= dContactBounce;
    p.bounce = config.restitution;
    p.bounce_vel = config.restitution_velocity_mps;
  }
  if (config.soft_erp) {
    p.mode |= dContactSoftERP;
    p.soft_erp = *config.soft_erp;
  }
  if (config.soft_cfm) {
    p.mode |= dContactSoftCFM;
    p.soft_cfm = *config.soft_cfm;
  }
  if (config.rolling_friction_m > 0 || config.spinning_friction_m > 0) {
    // dContactAxisDep: otherwise ODE would use rho for spinning friction too.
    p.mode |= dContactRolling | dContactAxisDep;
    p.rho = p.rho2 = config.rolling_friction_m;
    p.rhoN = config.spinning_friction_m;
    surface.rows += 3;
  }
  if (config.slip > 0) {
    p.mode |= dContactSlip1 | dContactSlip2;
    p.slip1 = p.slip2 = config.slip;
  }
  return surface;
}

std::uint64_t key_of(int first, int second) {
  const auto [low, high] = std::minmax(first, second);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
}

}  // namespace

ContactTable::ContactTable(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts)
    : contacts_(contacts) {
  MaterialConfig usual;
  usual.name = "default";
  add_materials({usual});
  add_materials(materials);
  compute_surfaces();
}

void ContactTable::add(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts) {
  const std::size_t known = contacts_.size(), known_materials = materials_.size();
  add_materials(materials);
  for (const ContactConfig& contact : contacts)
    if (std::find(contacts_.begin(), contacts_.end(), contact) == contacts_.end())
      contacts_.insert(contacts_.begin() + static_cast<std::ptrdiff_t>(added_++), contact);
  // A second vehicle of the same kind adds no materials or contacts.
  if (contacts_.size() > known || materials_.size() > known_materials) compute_surfaces();
}

void ContactTable::add_materials(const std::vector<MaterialConfig>& materials) {
  for (const MaterialConfig& material : materials)
    if (numbers_.emplace(material.name, static_cast<int>(materials_.size())).second) materials_.push_back(material);
}

void ContactTable::compute_surfaces() {
  // An entry that names both materials takes precedence over one with `any`; among equals the last one.
  std::vector<ContactConfig> by_weight = contacts_;
  std::stable_sort(by_weight.begin(), by_weight.end(), [](const ContactConfig& a, const ContactConfig& b) {
    const auto named = [](const ContactConfig& each) {
      return (each.between[0] != "any") + (each.between[1] != "any");
    };
    return named(a) < named(b);
  });
  surfaces_.assign(1, make_surface(ContactConfig{}));
  of_any_ = 0;
  of_material_.assign(materials_.size(), 0);
  of_pair_.clear();
  for (const ContactConfig& contact : by_weight) {
    const int surface = static_cast<int>(surfaces_.size());
    surfaces_.push_back(make_surface(contact));
    std::vector<int> named;
    bool known = true;
    for (const std::string& name : contact.between) {
      if (name == "any") continue;
      const auto found = numbers_.find(name);
      known = known && found != numbers_.end();
      if (known) named.push_back(found->second);
    }
    if (!known) continue;
    if (named.empty()) of_any_ = surface;
    if (named.size() == 1) of_material_[static_cast<std::size_t>(named[0])] = surface;
    if (named.size() == 2) of_pair_[key_of(named[0], named[1])] = surface;
  }
}

const Surface& ContactTable::of(int first, int second) const {
  if (!of_pair_.empty()) {
    const auto found = of_pair_.find(key_of(first, second));
    if (found != of_pair_.end()) return surfaces_[static_cast<std::size_t>(found->second)];
  }
  const int surface = std::max(
      {of_any_, of_material_[static_cast<std::size_t>(first)], of_material_[static_cast<std::size_t>(second)]});
  return surfaces_[static_cast<std::size_t>(surface)];
}

int ContactTable::number_of(const std::string& material) const {
  const auto found = numbers_.find(material);
  if (found == numbers_.end()) throw std::out_of_range("unknown material '" + material + "'");
  return found->second;
}

}  // namespace sim
