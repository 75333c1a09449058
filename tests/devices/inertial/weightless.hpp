// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace test {

/// `physics` of a world in which an accelerometer at rest reads zero.
inline constexpr const char* weightless = "{step_s: 0.001, gravity_mps2: 0}";

}  // namespace test
