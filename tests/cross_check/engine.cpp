// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cross_check/engine.hpp"

#include <algorithm>

namespace cross_check {

std::vector<Method> methods(const Model& model) {
  std::vector<Method> all{Method::shoal};
  if (model.ground ||
      std::any_of(model.bodies.begin(), model.bodies.end(), [](const auto& body) { return body.pivot; }))
    all.push_back(Method::shoal_quick);
  if (!mujoco_version().empty())
    all.insert(all.end(), {Method::mujoco_euler, Method::mujoco_implicit, Method::mujoco_rk4});
  return all;
}

std::string name_of(Method method) {
  switch (method) {
    case Method::shoal:
      return "Shoal";
    case Method::shoal_quick:
      return "Shoal, quick solver";
    case Method::mujoco_euler:
      return "MuJoCo Euler";
    case Method::mujoco_implicit:
      return "MuJoCo implicit";
    case Method::mujoco_rk4:
      break;
  }
  return "MuJoCo RK4";
}

std::unique_ptr<Engine> make_engine(Method method, const Model& model, double step_s) {
  const bool ours = method == Method::shoal || method == Method::shoal_quick;
  return ours ? make_shoal(method, model, step_s) : make_mujoco(method, model, step_s);
}

}  // namespace cross_check
