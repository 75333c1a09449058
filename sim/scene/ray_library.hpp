// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/choice_words.hpp"

namespace sim {

/// Library for ray casting.
enum class RayLibrary { embree, ode };

inline constexpr ChoiceWords<RayLibrary> ray_library_words{{"embree", RayLibrary::embree}, {"ode", RayLibrary::ode}};

}  // namespace sim
