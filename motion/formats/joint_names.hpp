// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace motion {

/// Names of joints in the files of one or more formats.
struct JointNameList {
  std::string list;                                        ///< its name, such as `tekkotsu`
  std::string design;                                      ///< how those files name the robot; empty: they do not
  bool complete = false;                                   ///< a file has all these joints, in this order
  std::vector<std::pair<std::string, std::string>> names;  ///< joint of the vehicle, and its name or number there
  void read(sim::ParamReader& in);
};

/// File of names of joints.
struct JointNamesFile {
  std::string vehicle;
  std::string description;
  std::vector<JointNameList> lists;
  void read(sim::ParamReader& in);
};

/// Reads a file of names of joints.  Throws sim::ConfigError with all errors.
JointNamesFile load_joint_names(const std::string& path);

/// Joint or light of a vehicle.
struct NamedJoint {
  std::string servo, alias;  ///< alias empty: none
  double rest = 0;           ///< value when a motion does not name it, rad or m
  bool is_slider = false;
  bool is_light = false;  ///< a light: `servo` is its name, and the value its intensity
};

/// Names of the joints of a vehicle, in motions and in files of other programs.  Without joints every name is kept.
class JointNames {
 public:
  JointNames() = default;
  JointNames(std::string vehicle, std::vector<NamedJoint> joints, std::vector<JointNameList> lists);

  bool empty() const { return joints_.empty(); }
  const std::string& vehicle() const { return vehicle_; }
  const std::vector<NamedJoint>& joints() const { return joints_; }
  /// Returns the joint with this name or alias; null: there is none.
  const NamedJoint* find(const std::string& name) const;
  /// Returns the list of this name; null: there is none.
  const JointNameList* find_list(const std::string& list) const;
  /// Returns the name of a joint of a motion in files of a format; unset: it has none there.  Throws sim::ConfigError
  /// for a joint that the vehicle does not have.
  std::optional<std::string> foreign_name(const std::string& list, bool uses_aliases, const std::string& joint) const;
  /// Returns the joint that files of a format call so; unset: there is none.
  std::optional<std::string> joint_of(const std::string& list, const std::string& foreign) const;
  /// Returns the names in files of a format.
  std::vector<std::string> foreign_names(const std::string& list) const;

 private:
  std::string vehicle_;
  std::vector<NamedJoint> joints_;
  std::vector<JointNameList> lists_;
};

}  // namespace motion
