// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/device_host.hpp"

#include <utility>

#include "sim/vehicle/mounted_device.hpp"

namespace sim {

void DeviceHost::schedule_arrival(int device, Time due, Bytes payload) {
  events.schedule({due, 0, device, MountedDevice::arrival_event, clock.now(), std::move(payload)});
}

}  // namespace sim
