// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "tests/cross_check/engine.hpp"

// Replaces mujoco_engine.cpp in a build without libmujoco-dev.

namespace cross_check {

std::string mujoco_version() {
  return "";
}

std::unique_ptr<Engine> make_mujoco(Method, const Model&, double) {
  throw std::runtime_error("cross_check: this build has no MuJoCo; install libmujoco-dev and configure again");
}

}  // namespace cross_check
