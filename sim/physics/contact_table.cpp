// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/contact_table.hpp"

#include <algorithm>
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

bool names(const std::string& pattern, const std::string& material) {
  return pattern == "any" || pattern == material;
}

}  // namespace

ContactTable::ContactTable(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts)
    : contacts_(contacts) {
  materials_.emplace_back().name = "default";
  add_materials(materials);
  compute_surfaces();
}

void ContactTable::add(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts) {
  add_materials(materials);
  const std::size_t known = contacts_.size();
  for (const ContactConfig& contact : contacts)
    if (std::find(contacts_.begin(), contacts_.end(), contact) == contacts_.end())
      contacts_.insert(contacts_.begin() + static_cast<std::ptrdiff_t>(added_++), contact);
  // A second vehicle of the same kind adds no materials or contacts.
  if (contacts_.size() > known || static_cast<int>(materials_.size()) > count_) compute_surfaces();
}

void ContactTable::add_materials(const std::vector<MaterialConfig>& materials) {
  for (const MaterialConfig& material : materials)
    if (find(material.name) == materials_.end()) materials_.push_back(material);
}

std::vector<MaterialConfig>::const_iterator ContactTable::find(const std::string& material) const {
  return std::find_if(materials_.begin(), materials_.end(), [&](const auto& each) { return each.name == material; });
}

void ContactTable::compute_surfaces() {
  count_ = static_cast<int>(materials_.size());
  surfaces_.assign(materials_.size() * materials_.size(), make_surface(ContactConfig{}));
  // An entry that names both materials takes precedence over one with `any`; among equals the last one.
  std::vector<ContactConfig> by_weight = contacts_;
  std::stable_sort(by_weight.begin(), by_weight.end(), [](const ContactConfig& a, const ContactConfig& b) {
    const auto named = [](const ContactConfig& each) {
      return (each.between[0] != "any") + (each.between[1] != "any");
    };
    return named(a) < named(b);
  });
  for (const ContactConfig& contact : by_weight)
    for (int i = 0; i < count_; ++i)
      for (int j = 0; j < count_; ++j)
        if (names(contact.between[0], materials_[i].name) && names(contact.between[1], materials_[j].name))
          surfaces_[i * count_ + j] = surfaces_[j * count_ + i] = make_surface(contact);
}

int ContactTable::number_of(const std::string& material) const {
  const auto at = find(material);
  if (at == materials_.end()) throw std::out_of_range("unknown material '" + material + "'");
  return static_cast<int>(at - materials_.begin());
}

}  // namespace sim
