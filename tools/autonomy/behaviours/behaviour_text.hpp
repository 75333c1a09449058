// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/autonomy/behaviours/helm_behaviour.hpp"

namespace autonomy {

/// A behaviour as on the command line:
///
///     route                        along `route`
///     circle:X,Y,RADIUS            round a point
///     zigzag:X1,Y1,X2,Y2,AMPLITUDE,LEGS
///     follow:VEHICLE,AHEAD,LEFT    beside another vehicle; its course is ahead
///
/// all in m, east and north.  Throws std::invalid_argument with what is wrong.
std::unique_ptr<HelmBehaviour> make_behaviour(const std::string& text, const std::vector<Vector2d>& route_W,
                                              double speed_mps, bool loop);

}  // namespace autonomy
