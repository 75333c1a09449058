// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/notice.hpp"

#include <spdlog/spdlog.h>

#include "sim/world/world.hpp"

namespace sim {

void notice(const World& world, const std::string& who, const std::string& text) {
  spdlog::warn("{}: {} (at {:.3f} s)", who, text, to_seconds(world.now()));
}

}  // namespace sim
