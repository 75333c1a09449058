// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/shared_by_devices.hpp"

#include <utility>

namespace sim {

namespace {

std::vector<detail::MakeShared>& shared_kinds() {
  static std::vector<detail::MakeShared> kinds;
  return kinds;
}

}  // namespace

std::size_t detail::register_shared_kind(MakeShared make) {
  shared_kinds().push_back(std::move(make));
  return shared_kinds().size() - 1;
}

SharedByDevices::SharedByDevices() {
  for (const detail::MakeShared& make : shared_kinds()) things_.push_back(make());
}

}  // namespace sim
