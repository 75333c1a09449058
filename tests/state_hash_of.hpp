// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/physics/physics_world.hpp"
#include "sim/state/state_archive.hpp"

namespace test {

/// The hash of what has visit_state().
template <typename T>
std::uint64_t state_hash_of(const T& state) {
  sim::StateArchive archive = sim::StateArchive::hasher();
  archive(const_cast<T&>(state));  // hashing changes nothing
  return archive.hash();
}

/// Of its bodies and joints too, which a World visits by vehicle.
inline std::uint64_t state_hash_of(const sim::PhysicsWorld& physics) {
  sim::StateArchive archive = sim::StateArchive::hasher();
  archive(const_cast<sim::PhysicsWorld&>(physics));
  bool there = false;
  const auto visit_all = [&](const auto& all) {
    for (const auto& each : all) {
      there = each != nullptr;
      archive(there);
      if (there) archive(*each);
    }
  };
  visit_all(physics.bodies());
  visit_all(physics.joints());
  return archive.hash();
}

}  // namespace test
