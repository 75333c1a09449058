// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <span>
#include <unordered_map>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/collision/collider.hpp"

namespace sim {

/// Forces at the contacts between the vehicles of a crowd, by sequential impulses (Catto 2005, Iterative dynamics with
/// temporal coherence, Game Developers Conference): each vehicle counts as one rigid body, with its present motion and
/// the forces on it, so that what holds it from the ground takes effect in the next step.
class CrowdContacts {
 public:
  struct Settings {
    double step_s;
    double erp, cfm;
    double surface_layer_m;
    double max_correcting_velocity_mps;
  };
  explicit CrowdContacts(const Settings& settings) : settings_(settings) {}

  /// Whether the impulses stand for this contact: what lies on a vehicle is held up by what is under it, and rolling
  /// friction or slip need the solver's rows.
  static bool can_solve(const dContact& contact);

  void clear();
  /// Adds a body of a vehicle.  `vehicle`: the same number for all bodies that joints connect.
  void add_body(dBodyID ode, double mass_kg, const Matrix3d& inertia_C_B, int vehicle);
  /// Adds a contact between bodies that were added, or one that was added and a kinematic one.
  void add_contact(const Collider::Between& contact);
  /// Adds the forces to the bodies, and writes them to the feedback of the joints that have one.
  void solve();

 private:
  struct Member {
    dBodyID ode;
    double mass_kg;
    Matrix3d inertia_C_B;
  };
  struct Vehicle {
    double mass_kg = 0, inverse_mass = 0;
    Vector3d p_WC = Vector3d::Zero();  // center of mass
    Matrix3d inverse_inertia_W = Matrix3d::Zero();
    Vector3d dv_W = Vector3d::Zero(), dw_W = Vector3d::Zero();  // by the impulses
    std::vector<Member> bodies;
  };
  /// A direction in which a contact pushes: along the normal or a tangent.
  struct Row {
    Vector3d along_W;
    Vector3d levers_W[2];     // arm x direction, for the two vehicles; zero for a kinematic body
    Vector3d turns_W[2];      // by the inverse inertia
    double approach_mps;      // without the impulses
    double inverse_mass = 0;  // of both vehicles in this direction
    double impulse_Ns = 0;
  };
  struct Contact {
    const Collider::Between* between;
    int vehicles[2];  // the last one, which does not move, for a kinematic body
    Row rows[3];      // along the normal, and two tangents
    double desired_mps;
    double cfm_ph;  // CFM by the step
  };
  int vehicle_of(dBodyID body) const;
  void find_motion(Vehicle& vehicle) const;
  void find_rows(Contact& contact);
  double rate_mps(const Contact& contact, const Row& row) const;
  void push(const Contact& contact, Row& row, double impulse_Ns);
  void iterate(Contact& contact);
  void add_force(const Contact& contact) const;

  Settings settings_;
  std::vector<Vehicle> vehicles_;
  std::unordered_map<int, int> numbers_;  // index in vehicles_ by the caller's number; never iterated
  std::unordered_map<dBodyID, int> of_body_;
  std::vector<Contact> contacts_;
};

}  // namespace sim
