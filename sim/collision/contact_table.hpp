// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim/model/physics_config.hpp"

namespace sim {

/// ODE contact parameters of two materials.
struct Surface {
  dSurfaceParameters parameters = {};
  int rows = 1;  ///< constraint rows of one contact
  bool friction = false;
};

/// Contact parameters of each pair of materials.  Its memory grows with the materials and contacts, not with the pairs.
class ContactTable {
 public:
  ContactTable(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  /// Adds materials and contacts.  Numbers of known materials are stable; the contacts given at construction take
  /// precedence over later ones.
  void add(const std::vector<MaterialConfig>& materials, const std::vector<ContactConfig>& contacts);
  const Surface& of(int first, int second) const;
  int materials() const { return static_cast<int>(materials_.size()); }
  /// Material by number; 0 is `default`.
  const MaterialConfig& material(int number) const { return materials_[static_cast<std::size_t>(number)]; }
  /// Number of a material; `default` always exists.  Throws std::out_of_range.
  int number_of(const std::string& material) const;

 private:
  void add_materials(const std::vector<MaterialConfig>& materials);
  void compute_surfaces();

  std::vector<MaterialConfig> materials_;
  std::vector<ContactConfig> contacts_;           // by precedence: added ones, then those of construction
  std::size_t added_ = 0;                         // number of added contacts
  std::unordered_map<std::string, int> numbers_;  // of materials
  std::vector<Surface> surfaces_;                 // the usual one, then those of contacts, by ascending precedence
  // Numbers of surfaces: of two materials that no contact names, of a material with any other, and of named pairs.
  int of_any_ = 0;
  std::vector<int> of_material_;
  std::unordered_map<std::uint64_t, int> of_pair_;
};

}  // namespace sim
