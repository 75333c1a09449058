// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_vehicle.hpp"

#include <utility>

#include "tools/shoal/urdf/body_assembly.hpp"
#include "tools/shoal/urdf/imported_joint.hpp"
#include "tools/shoal/urdf/shoal_names.hpp"
#include "tools/shoal/urdf/urdf_tree.hpp"

namespace tools {

namespace {

/// Walks from the root to the ends, and starts a body at each joint that is not fixed.
class VehicleAssembly {
 public:
  explicit VehicleAssembly(ImportedVehicle& vehicle) : vehicle_(vehicle) {}

  /// Adds a link whose parent was added before.
  void add(const UrdfBranch& branch) {
    const UrdfJoint* joint = branch.joint;
    const Place parent = joint != nullptr ? places_[branch.parent] : Place{};
    const sim::Pose X_VL = joint != nullptr ? parent.X_VL * joint->X_PJ : sim::Pose::Identity();
    if (joint == nullptr && is_world(*branch.link)) return places_.push_back({X_VL, no_body});
    const bool merges = joint != nullptr && joint->type == UrdfJointType::fixed && parent.body != no_body;
    if (!merges) start_body(*branch.link, X_VL);
    places_.push_back({X_VL, merges ? parent.body : bodies_.size() - 1});
    bodies_[places_.back().body].add(*branch.link, X_VL, vehicle_.notes);
    if (joint == nullptr || merges) return;
    const std::string first = parent.body == no_body ? "world" : bodies_[parent.body].name();
    add_joint(*joint, {first, bodies_.back().name()}, X_VL.linear());
  }
  void fix_base() {
    if (bodies_.empty() || places_.front().body == no_body) return;  // it is fixed
    bodies_.front().allow_no_mass();
    UrdfJoint joint;
    joint.name = "fixed_base";
    add_joint(joint, {"world", bodies_.front().name()}, sim::Matrix3d::Identity());
  }
  void finish(const UrdfLink& root) {
    if (bodies_.empty()) sim::throw_config_error(root.place, "", "a robot needs a link other than 'world'");
    for (BodyAssembly& body : bodies_) vehicle_.bodies.push_back(body.finish(vehicle_.notes));
  }

 private:
  static constexpr std::size_t no_body = static_cast<std::size_t>(-1);
  struct Place {
    sim::Pose X_VL = sim::Pose::Identity();
    std::size_t body = no_body;
  };

  /// A root link that stands for the world, by custom.
  static bool is_world(const UrdfLink& link) {
    return link.name == "world" && !link.inertial && link.collisions.empty() && link.visuals.empty();
  }
  void start_body(const UrdfLink& link, const sim::Pose& X_VB) {
    bodies_.emplace_back(body_names_.add(link.name, link.place, vehicle_.notes), X_VB, link.place);
  }
  void add_joint(const UrdfJoint& joint, const JointEnds& ends, const sim::Matrix3d& R_VJ) {
    const std::string name = joint_names_.add(joint.name, joint.place, vehicle_.notes);
    vehicle_.joints.push_back(imported_joint(joint, name, ends, R_VJ, vehicle_.notes));
  }

  ImportedVehicle& vehicle_;
  ShoalNames body_names_{"link", {"any", "world", "sim"}};
  ShoalNames joint_names_{"joint", {"any", "world", "sim", "joints"}};  // and the device `joints`
  std::vector<BodyAssembly> bodies_;
  std::vector<Place> places_;  ///< of the links, in the order of the branches
};

}  // namespace

ImportedVehicle vehicle_of(const UrdfRobot& robot, const std::string& file_name, Base base) {
  ImportedVehicle vehicle;
  vehicle.name = plain_name(robot.name);
  vehicle.source = file_name;
  vehicle.comment = robot.comment;
  vehicle.notes = robot.notes;
  VehicleAssembly assembly(vehicle);
  const std::vector<UrdfBranch> branches = branches_of(robot);
  for (const UrdfBranch& branch : branches) assembly.add(branch);
  if (base == Base::fixed) assembly.fix_base();
  assembly.finish(*branches.front().link);
  return vehicle;
}

}  // namespace tools
