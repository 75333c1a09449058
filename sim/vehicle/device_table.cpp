// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/device_table.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace sim {

int DeviceTable::next_number() {
  if (free_.empty()) {
    free_.push_back(static_cast<int>(devices_.size()));
    devices_.emplace_back();
  }
  return free_.back();
}

void DeviceTable::add(std::unique_ptr<MountedDevice> device) {
  const int number = device->number();
  if (device->mailbox()) device->mailbox()->raise_on_arrival(arrival_flags_.of(number));
  free_.pop_back();
  devices_[static_cast<std::size_t>(number)] = std::move(device);
}

void DeviceTable::remove(int number) {
  free_.push_back(number);
  devices_[static_cast<std::size_t>(number)].reset();
}

void DeviceTable::clear() {
  devices_.clear();
  free_.clear();
}

void DeviceTable::prescribe(const std::vector<int>& numbers) {
  constexpr int max_number = 10'000'000;
  free_.assign(numbers.rbegin(), numbers.rend());
  for (const int number : free_) {
    if (number < 0 || number >= max_number) throw std::out_of_range("a device");
    const auto place = static_cast<std::size_t>(number);
    if (place >= devices_.size()) devices_.resize(place + 1);
    if (devices_[place]) throw std::out_of_range("a device");
  }
  if (std::set<int>(free_.begin(), free_.end()).size() != free_.size()) throw std::out_of_range("a device");
}

void DeviceTable::set_free(std::vector<int> free, std::int64_t size) {
  const auto there = static_cast<std::size_t>(
      std::count_if(devices_.begin(), devices_.end(), [](const auto& device) { return device != nullptr; }));
  const auto places = static_cast<std::size_t>(size);
  std::vector<int> sorted = free;
  std::sort(sorted.begin(), sorted.end());
  const auto taken = [&](int number) {
    return number < 0 || number >= size ||
           (static_cast<std::size_t>(number) < devices_.size() && at(number) != nullptr);
  };
  // A snapshot may be damaged: numbers in use and free ones must make up all numbers, each once.
  if (places < devices_.size() || there + free.size() != places ||
      std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end() || std::any_of(free.begin(), free.end(), taken))
    throw SnapshotError("the snapshot has an invalid value: numbers of devices");
  devices_.resize(places);
  free_ = std::move(free);
}

void DeviceTable::visit_messages(StateArchive& archive) {
  std::map<int, std::vector<Message>> messages;
  for (const auto& device : devices_) {
    if (!device || !device->mailbox() || archive.restoring()) continue;
    if (std::vector<Message> unread = device->mailbox()->unread(); !unread.empty())
      messages[device->number()] = std::move(unread);
  }
  archive(messages);
  if (!archive.restoring()) return;
  for (const auto& device : devices_)
    if (device && device->mailbox()) device->mailbox()->set_unread(std::move(messages[device->number()]));
}

}  // namespace sim
