// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/bus/message_gate.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace sim {

/// Devices of a world by number.  Numbers of removed devices are reused, the last released first.
class DeviceTable {
 public:
  /// Returns the devices in the order of their numbers; null where a device was removed.
  std::span<const std::unique_ptr<MountedDevice>> all() const { return devices_; }
  std::size_t size() const { return devices_.size(); }
  /// Returns a device by number; null when there is none.
  MountedDevice* at(int number) const { return devices_[static_cast<std::size_t>(number)].get(); }
  /// Returns the number of the device that is added next.
  int next_number();
  /// Adds a device that was built with next_number().
  void add(std::unique_ptr<MountedDevice> device);
  void remove(int number);
  void clear();
  /// Returns the flag that is set when a message arrives in the mailbox of the device.
  std::atomic<bool>* arrival_flag(int number) { return arrival_flags_.of(number).get(); }

  // Used to reconstruct a world from its journal.
  const std::vector<int>& free_numbers() const { return free_; }
  /// Sets the numbers of the devices that are added next.  Throws std::out_of_range when one is in use.
  void prescribe(const std::vector<int>& numbers);
  bool as_prescribed() const { return free_.empty(); }
  /// Sets the free numbers, in the order in which they will be used.  Throws SnapshotError when they are invalid.
  void set_free(std::vector<int> free, std::int64_t size);
  /// Visits the unread messages of the mailboxes.
  void visit_messages(StateArchive& archive);

 private:
  ArrivalFlags arrival_flags_;
  std::vector<std::unique_ptr<MountedDevice>> devices_;
  std::vector<int> free_;  // the last is used first
};

}  // namespace sim
