// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "autonomy/cooperative/driver/vehicle_navigation.hpp"

namespace navigation {

/// Name of a model of sound in options and worlds.
const std::map<std::string, SoundModel>& sound_models();

/// Arguments of a `shoal-nav` process of a world that change the estimates; those that its world does not set are
/// empty.
struct NavArguments {
  std::optional<Vector2> start_m;
  std::optional<double> start_std_m;
  std::optional<std::int64_t> period_us;
  std::optional<SoundModel> sound;

  /// Returns these options with the arguments.
  NavOptions applied_to(NavOptions options) const;
};

/// Returns the arguments by vehicle, from a world as text, such as sim_info_t::resolved_config.  What `shoal-nav` would
/// refuse is left out.  Throws sim::ConfigError when the text is not YAML.
std::map<std::string, NavArguments> nav_arguments_of(const std::string& resolved_world);

}  // namespace navigation
