// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/device_host.hpp"

#include <utility>

#include "sim/world/mounted_device.hpp"

namespace sim {

void DeviceHost::schedule_arrival(int device, Time due, Bytes payload) {
  events.schedule({due, 0, device, MountedDevice::arrival_event, clock.now(), std::move(payload)});
}

}  // namespace sim
