// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/base/math.hpp"

namespace sim {

class AcousticChannel;
class Body;
class DeviceFaults;

/// Where a device puts sound into the water and takes it out.  What it refers to outlives the transducer.
struct SoundSite {
  AcousticChannel& channel;
  const Body& body;            ///< that carries it
  Pose X_BS;                   ///< of the device in that body; x is the axis
  int group;                   ///< of the bodies that do not block its own sound
  const bool& powered;         ///< false: it neither sends nor receives
  const DeviceFaults& faults;  ///< of the device
  std::string full_name;       ///< such as `auv1/modem`
};

}  // namespace sim
