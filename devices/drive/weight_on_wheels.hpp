// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Warns when the load on the driven wheels is statically indeterminate.
/// A rigid vehicle on flat ground rests on points (x_i, y_i) with forces f_i that balance its weight and its moments:
/// three equations, for sum f_i, sum x_i f_i and sum y_i f_i.  The total load on the driven wheels follows from them
/// only if there are a, b, c with a + b x_i + c y_i = 1 at each driven wheel and 0 at each other point.  This holds
/// with up to three points, with wheels on one axle and casters on one line beside it, and when all wheels are driven.
/// This fails with casters in front of and behind the axle: the load then depends on rounding, and may be close to
/// zero.  Excluded: vehicles with a suspension or compliant joints, soft contacts, no gravity, wheels of other shapes.
void warn_of_shared_weight(const sim::DeviceContext& context, const std::vector<std::string>& driven_joints);

}  // namespace devices
