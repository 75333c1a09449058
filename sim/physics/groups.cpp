// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/groups.hpp"

#include <stdexcept>
#include <utility>

namespace sim {

int Groups::add(const std::string& name) {
  const int number = group_numbers_.take();
  Group& added = slot(groups_, number);
  added.name = name;
  added.in_use = true;
  return number;
}

Group& Groups::at(int number) {
  if (number < 0 || number >= count() || !(*this)[number].in_use)
    throw std::out_of_range("no group " + std::to_string(number));
  return (*this)[number];
}

void Groups::add_body(std::unique_ptr<SteppedBody> body) {
  Group& owner = (*this)[body->group()];
  owner.bodies.push_back(body_numbers_.take());
  if (!body->fixed()) owner.moving.push_back(body.get());
  slot(bodies_, owner.bodies.back()) = std::move(body);
}

void Groups::add_joint(Group& owner, std::unique_ptr<SteppedJoint> joint) {
  owner.anchored |= joint->origin().to_world;
  owner.joints.push_back(joint_numbers_.take());
  slot(joints_, owner.joints.back()) = std::move(joint);
}

void Groups::destroy_joints(const Group& removed) {
  for (const int joint : removed.joints) joints_[static_cast<std::size_t>(joint)].reset();
}

void Groups::destroy_bodies(const Group& removed) {
  for (const int body : removed.bodies) bodies_[static_cast<std::size_t>(body)].reset();
}

void Groups::remove(int number) {
  Group& removed = (*this)[number];
  for (const int joint : removed.joints) joint_numbers_.give_back(joint);
  for (const int body : removed.bodies) body_numbers_.give_back(body);
  removed = {};
  group_numbers_.give_back(number);
}

void Groups::prescribe(const GroupNumbers& numbers) {
  group_numbers_.prescribe({numbers.group});
  body_numbers_.prescribe(numbers.bodies);
  joint_numbers_.prescribe(numbers.joints);
}

bool Groups::as_prescribed() const {
  return group_numbers_.as_prescribed() && body_numbers_.as_prescribed() && joint_numbers_.as_prescribed();
}

}  // namespace sim
