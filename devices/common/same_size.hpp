// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include "sim/state/state_archive.hpp"

namespace devices {

/// Visits a vector whose size is determined by the parameters of the device.  `of`: name of the values, for the error
/// of a snapshot with another size.
template <typename T>
void visit_same_size(sim::StateArchive& archive, std::vector<T>& values, std::string_view of) {
  static_assert(std::is_arithmetic_v<T>);
  archive.expect_count(values.size(), of);
  archive.raw(values.data(), values.size() * sizeof(T));
  if constexpr (std::is_floating_point_v<T>) {
    constexpr T max = static_cast<T>(sim::StateArchive::max_number);
    for (const T value : values) archive.require(value, -max, max, of);
  }
}

}  // namespace devices
