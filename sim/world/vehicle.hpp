#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/math.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/joint.hpp"

namespace sim {

/// A vehicle in the world: its bodies and joints by name.
class Vehicle {
 public:
  Vehicle(std::string name, int number, int group, const Pose& X_BV)
      : name_(std::move(name)), number_(number), group_(group), X_BV_(X_BV) {}

  const std::string& name() const { return name_; }
  int number() const { return number_; }
  int group() const { return group_; }
  /// The first body, which carries the vehicle frame.
  const Body& base() const { return *bodies_.front().second; }
  Pose X_WV() const { return base().X_WB() * X_BV_; }

  /// By the name in the vehicle file.  Throws std::out_of_range.
  Body& body(const std::string& name) const;
  Joint& joint(const std::string& name) const;
  const std::vector<std::pair<std::string, Body*>>& bodies() const { return bodies_; }
  const std::vector<std::pair<std::string, Joint*>>& joints() const { return joints_; }

  void add_body(const std::string& name, Body& body) { bodies_.emplace_back(name, &body); }
  void add_joint(const std::string& name, Joint& joint) { joints_.emplace_back(name, &joint); }

 private:
  std::string name_;
  int number_;
  int group_;
  Pose X_BV_;
  std::vector<std::pair<std::string, Body*>> bodies_;
  std::vector<std::pair<std::string, Joint*>> joints_;
};

}  // namespace sim
