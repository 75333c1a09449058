// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

namespace sim {

class World;
struct MechanismConfig;
struct PartConfig;

/// Which parts collide with anything in a world, by their categories.
class PartCollisions {
 public:
  explicit PartCollisions(const World& world);

  /// Returns whether a part of the vehicle or object `owner` collides with any other one.  A part that collides with
  /// all categories does, even where it is alone.
  bool has(const PartConfig& part, const std::string& owner) const;

 private:
  /// Parts that collide with the same ones.
  struct Kind {
    std::string category;
    std::vector<std::string> collides_with;
    std::set<std::string> owners;     ///< vehicles and objects that have them, two at most
    std::set<std::string> with_self;  ///< those whose own parts collide with each other
  };

  void add(const MechanismConfig& config, const std::string& owner);
  void add(const PartConfig& part, const std::string& owner, bool self_collision);

  std::vector<Kind> kinds_;
};

}  // namespace sim
