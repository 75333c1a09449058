// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"

namespace sim {

/// ODE contact parameters of two materials.
struct Surface {
  dSurfaceParameters parameters = {};
  int rows = 1;  ///< constraint rows of one contact
  bool friction = false;
};

/// Contact parameters of each pair of materials, computed once.
class ContactTable {
 public:
  ContactTable(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  /// Adds materials and contacts.  Numbers of known materials are stable; the contacts given at construction take
  /// precedence over later ones.
  void add(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  const Surface& of(int first, int second) const { return surfaces_[first * count_ + second]; }
  int materials() const { return count_; }
  /// Material by number; 0 is `default`.
  const MaterialConfig& material(int number) const { return materials_[static_cast<std::size_t>(number)]; }
  /// Number of a material; `default` always exists.  Throws std::out_of_range.
  int number_of(const std::string& material) const;

 private:
  void add_materials(const std::vector<MaterialConfig>& materials);
  std::vector<MaterialConfig>::const_iterator find(const std::string& material) const;
  void compute_surfaces();

  std::vector<MaterialConfig> materials_;
  std::vector<ContactConfig> contacts_;  // by precedence: added ones, then those of construction
  std::size_t added_ = 0;                // number of added contacts
  int count_ = 0;
  std::vector<Surface> surfaces_;
};

}  // namespace sim
