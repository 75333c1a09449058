// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"

namespace sim {

/// What ODE needs to know of a contact of two materials.
struct Surface {
  dSurfaceParameters parameters = {};
  int rows = 1;  ///< constraint rows of one contact
  bool friction = false;
};

/// A surface for each pair of materials, computed once.
class ContactTable {
 public:
  ContactTable(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  /// More of them.  Numbers of known materials are stable; the contacts given at construction take precedence over
  /// later ones.
  void add(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  const Surface& of(int first, int second) const { return surfaces_[first * count_ + second]; }
  int materials() const { return count_; }
  /// By number; 0 is `default`.
  const MaterialConfig& material(int number) const { return materials_[static_cast<std::size_t>(number)]; }
  /// Number of a material; `default` is always there.  Throws std::out_of_range.
  int number_of(const std::string& material) const;

 private:
  void add_materials(const std::vector<MaterialConfig>& materials);
  std::vector<MaterialConfig>::const_iterator find(const std::string& material) const;
  void compute_surfaces();

  std::vector<MaterialConfig> materials_;
  std::vector<ContactConfig> contacts_;  // in the order of precedence: the added ones, then those of construction
  std::size_t added_ = 0;                // how many of them were added
  int count_ = 0;
  std::vector<Surface> surfaces_;
};

}  // namespace sim
