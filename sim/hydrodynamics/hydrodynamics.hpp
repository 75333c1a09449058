// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/thread_pool.hpp"
#include "sim/hydrodynamics/immersed_bodies.hpp"
#include "sim/medium/medium.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/physics/body.hpp"

namespace sim {

class CoefficientModel;
struct CraftState;
struct Six;

/// Hydrodynamic forces on the bodies of a world: stage 3 of a step.
class Hydrodynamics {
 public:
  /// Receives warnings during a step: name of the body, and text.
  using Warn = std::function<void(const std::string& who, const std::string& text)>;

  /// `warn` may be empty.
  Hydrodynamics(const Medium& medium, double gravity_mps2, double step_s, Warn warn = {});

  /// Adds a free body; no effect for one without hydrodynamics.  Throws ConfigError.
  void add_body(Body& body, const BodyConfig& config);
  /// Removes the bodies of a group, before they are destroyed.
  void remove_group(int group);

  /// Actuators that act while the bodies of one group after the other are stepped.
  struct Actors {
    /// Lets the actuators of a group act, which must neither read nor change bodies of other groups.  Threads call it
    /// for several groups at once.  Must not throw.
    std::function<void(int group)> act;
    /// Is called once after all groups, before any exception of the water is thrown.  May throw.
    std::function<void()> finish;
  };
  /// Does the work of begin_step(), the actuators and step(), group by group, so that the data of a vehicle stay in the
  /// cache.  The results are the same.
  void step_by_groups(double gravity_mps2, const Actors& actors, ThreadPool* threads = nullptr);

  /// Updates the water around each body, before actuators act on it.  `threads` share the bodies; may be null.
  void begin_step(ThreadPool* threads = nullptr);
  /// Water at a body's origin in this step.
  const LocalWater& water_at(const Body& body) const { return around(body).water; }
  /// Motion of a body and of the water around it; `known` is false for a body without hydrodynamics.
  const BodyInWater& around(const Body& body) const {
    const auto number = static_cast<std::size_t>(body.number());
    return number < around_.size() ? around_[number] : nowhere_;
  }
  /// Motion of a body at which forces act in this step.
  BodyMotion motion_of(const Body& body) const {
    const BodyInWater& found = around(body);
    return found.known ? found.motion : body.motion_for_forces(step_s_);
  }
  /// Adds the hydrodynamic forces to those that actuators applied to the bodies in this step.  `threads` share the
  /// bodies; may be null.  If several bodies throw, the exception of the first is reported.
  void step(double gravity_mps2, ThreadPool* threads = nullptr);
  /// Returns the warnings about bodies since the last call.
  std::vector<Warning> take_warnings() { return std::exchange(warnings_, {}); }

  /// Visits the last water values of bodies in the air, and which warnings were given.
  void visit_state(StateArchive& archive);

 private:
  struct CoefficientBody {
    Body* body;
    std::shared_ptr<const CoefficientModel> model;
    bool stiffness_warned = false;
  };
  struct Wetted {
    Body* body;
    double radius_m;                // bounding radius about its origin
    bool current_by_yaw_only;       // a quirk of its coefficients
    bool left_the_current = false;  // a warning was given
  };
  /// Bodies of a group, as ranges of wetted_ and crafts_.
  struct InWater {
    int group;
    std::size_t wetted_begin, wetted_end, crafts_begin, crafts_end;
  };
  void list_groups();
  void add_craft(Body& body, const HydrodynamicsConfig& config);
  class LateWarnings;
  void begin_step_of(Wetted& wetted, double highest_m, LateWarnings& late);
  void step_craft(CoefficientBody& craft, LateWarnings& late);
  void step_by_midpoint(const CoefficientBody& craft, CraftState state, const BodyInWater& around);
  static Vector6d applied_to(const Body& body, const CoefficientModel& model, const Matrix3d& R_WB);
  void warn_of_stiffness(CoefficientBody& craft, const Six& nu_r, double fastest_rate, LateWarnings& late) const;
  CraftState state_of(const CoefficientModel& model, const BodyInWater& around) const;
  static void warn_of_missing_current(Wetted& wetted, const Vector3d& p_WB, LateWarnings& late);
  void check_step(const CoefficientModel& model, const HydrodynamicsConfig& config, const std::string& who);

  const Medium& medium_;
  double gravity_mps2_;
  double step_s_;
  std::vector<CoefficientBody> crafts_;  // in order of addition, the bodies of a group together
  ImmersedBodies floaters_;              // bodies without coefficients
  std::vector<BodyInWater> around_;      // by body number
  const BodyInWater nowhere_;
  std::vector<Wetted> wetted_;  // bodies whose water begin_step() updates, in order of addition too
  std::vector<InWater> groups_;
  bool groups_listed_ = false;
  std::vector<Warning> warnings_;
  Warn warn_;
  // Models, shared by identical vehicles.
  std::map<const HydrodynamicsConfig*, std::weak_ptr<const CoefficientModel>> models_;
};

}  // namespace sim
