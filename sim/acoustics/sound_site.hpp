// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/base/math.hpp"

namespace sim {

class AcousticChannel;
class Body;
class DeviceFaults;

/// Mounting of a transducer.  The referenced objects must outlive the transducer.
struct SoundSite {
  AcousticChannel& channel;
  const Body& body;            ///< body that carries the device
  Pose X_BS;                   ///< pose of the device in that body; x is the acoustic axis
  int group;                   ///< group whose bodies do not block its own sound
  const bool& powered;         ///< false: it neither sends nor receives
  const DeviceFaults& faults;  ///< of the device
  std::string full_name;       ///< such as `auv1/modem`
};

}  // namespace sim
