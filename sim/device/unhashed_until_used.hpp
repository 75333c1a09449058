// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/device/device.hpp"

namespace sim {

/// Sensor that has no effect until something uses it, such as lights that were never switched.  Until then it publishes
/// nothing, and is not part of hashes: a vehicle that gets such a device keeps the run hashes of its worlds.  Snapshots
/// have it always.
class UnhashedUntilUsed {
 public:
  virtual ~UnhashedUntilUsed() = default;
  /// Returns whether it was used since the start of the run.
  virtual bool used() const = 0;
};

/// Returns whether the device of a sensor is not part of hashes.  `sensor`: null for a device that has none.
inline bool is_unused(const Sensor* sensor) {
  const auto* const quiet = dynamic_cast<const UnhashedUntilUsed*>(sensor);
  return quiet != nullptr && !quiet->used();
}

}  // namespace sim
