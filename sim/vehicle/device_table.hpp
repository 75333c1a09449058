// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/bus/arrival_flags.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace sim {

/// The devices of a world by number.  The number of a removed device is used again, that of the last one first.
class DeviceTable {
 public:
  /// In the order of their numbers; null where a device was removed.
  std::span<const std::unique_ptr<MountedDevice>> all() const { return devices_; }
  std::size_t size() const { return devices_.size(); }
  /// Null when there is none.
  MountedDevice* at(int number) const { return devices_[static_cast<std::size_t>(number)].get(); }
  /// Of the device that is added next.
  int next_number();
  /// One that was built with next_number().
  void add(std::unique_ptr<MountedDevice> device);
  void remove(int number);
  void clear();
  /// Raised when something arrives in the mailbox of the device.
  std::atomic<bool>* arrival_flag(int number) { return arrival_flags_.of(number).get(); }

  // For who builds a world again as it became.
  const std::vector<int>& free_numbers() const { return free_; }
  /// The devices that are added next get these numbers.  Throws std::out_of_range when one is in use.
  void prescribe(const std::vector<int>& numbers);
  bool as_prescribed() const { return free_.empty(); }
  /// The numbers that are free, in the order in which they will be used.  Throws SnapshotError when they cannot be.
  void set_free(std::vector<int> free, std::int64_t size);
  /// What waits in the mailboxes.
  void visit_messages(StateArchive& archive);

 private:
  ArrivalFlags arrival_flags_;
  std::vector<std::unique_ptr<MountedDevice>> devices_;
  std::vector<int> free_;  // the last is used first
};

}  // namespace sim
