// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace test {

inline constexpr std::int64_t second = 1'000'000;  ///< in microseconds

}  // namespace test
