// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/cross_check/model.hpp"

namespace cross_check {

/// The engine found its state to be unusable: it diverged.
struct Diverged : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A model in an engine.
class Engine {
 public:
  virtual ~Engine() = default;
  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual void step() = 0;  ///< throws Diverged
  /// State at the end of the last step, by the number of the body in the model.
  virtual BodyState state(int body) const = 0;
};

/// Engine with its solver or integrator.  `shoal`: as by default; `shoal_quick`: `physics.solver: quick`.
enum class Method { shoal, shoal_quick, mujoco_euler, mujoco_implicit, mujoco_rk4 };

/// Methods for a model: Shoal, its quick solver where there is something to solve (joints, contacts), and the
/// integrators of MuJoCo when the build has found it.
std::vector<Method> methods(const Model& model);
/// Name of a method in tables.
std::string name_of(Method method);
/// Version of MuJoCo, such as `2.2.2`; empty when the build has not found it.
std::string mujoco_version();

/// Throws std::runtime_error when the engine refuses the model.
std::unique_ptr<Engine> make_engine(Method method, const Model& model, double step_s);

std::unique_ptr<Engine> make_shoal(Method method, const Model& model, double step_s);
std::unique_ptr<Engine> make_mujoco(Method method, const Model& model, double step_s);

}  // namespace cross_check
