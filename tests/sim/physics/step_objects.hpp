// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "sim/physics/single_bodies.hpp"
#include "sim/physics/step_report.hpp"
#include "tests/sim/physics/small_worlds.hpp"

/// The objects of a step without a PhysicsWorld: a test calls those that it is about.
struct StepObjects {
  explicit StepObjects(const sim::PhysicsConfig& config = small_worlds::weightless())
      : settings{config, 1},
        shards(settings, groups, collider, islands, moved),
        collider(config, sim::ContactTable({}, {})),
        far_groups(groups, collider, moves),
        leaps(config.step_s, groups, far_groups),
        moved(config, collider, far_groups, leaps),
        singles(settings, groups, shards, far_groups, moved),
        scene(sim::make_world_scene(config.rays, moves)) {}

  /// Adds a body to a group.
  sim::SteppedBody& add_body(int group, const sim::BodyConfig& config, const sim::Pose& X_WB,
                             sim::Motion motion = sim::Motion::free) {
    auto owned = std::make_unique<sim::SteppedBody>(config.name, groups.next_body(), group, motion, moves);
    sim::SteppedBody& body = *owned;
    const bool fixed = motion == sim::Motion::fixed;
    if (!fixed) body.create(shards.world_of(group));
    for (const int part : parts.add(body, config, collider, *scene)) {
      groups[group].parts.push_back(part);
      shards.add_part(part, group, fixed);
    }
    collider.add_body(body.number(), body.for_collider());
    islands.add_body(body.number());
    body.set_pose(X_WB);
    groups.add_body(std::move(owned));
    if (!fixed) shards.note_change(group);
    return body;
  }
  int add_group(const std::string& name) {
    const int group = groups.add(name);
    scene->add_group(group);
    collider.add_group(group, false);
    return group;
  }
  void close(int group) {
    collider.close_group(group);
    scene->close_group(group);
    far_groups.note(group);
  }
  /// Adds a group of one body.
  sim::SteppedBody& add(const sim::BodyConfig& config, const sim::Pose& X_WB, sim::Motion motion = sim::Motion::free) {
    const int group = add_group(config.name);
    sim::SteppedBody& body = add_body(group, config, X_WB, motion);
    close(group);
    return body;
  }
  sim::SteppedBody& add_ball(const std::string& name, double x_m, double v_x_mps = 0) {
    sim::SteppedBody& ball =
        add(small_worlds::body(name, {small_worlds::sphere(0.5, 1)}), small_worlds::translation(x_m, 0, 0));
    ball.set_velocity_W({v_x_mps, 0, 0}, sim::Vector3d::Zero());
    return ball;
  }
  /// A joint between two bodies of a group.
  sim::SteppedJoint& add_joint(int group, const sim::JointConfig& config, sim::SteppedBody& first,
                               sim::SteppedBody* second) {
    auto owned =
        std::make_unique<sim::SteppedJoint>(dBodyGetWorld(first.ode()), config.name, config, first.ode(),
                                            second == nullptr ? nullptr : second->ode(), sim::Pose::Identity());
    sim::SteppedJoint& joint = *owned;
    islands.add_joint(first.number(), second == nullptr ? -1 : second->number(), joint.max_rows());
    groups.add_joint(groups[group], std::move(owned));
    shards.note_change(group);
    return joint;
  }
  /// The part of a step before bodies move, with the pairs that are found.
  void deal(std::int64_t step_number = 1) {
    islands.begin_step();
    singles.list_again();
    const std::vector<sim::Collider::Pair> pairs = collider.find_pairs();
    shards.bring_together(pairs, step_number);
    singles.list_again();
    shards.give_pairs(pairs);
  }

  // ODE first.
  const bool ode_started = (sim::start_ode(), true);
  sim::StepSettings settings;
  sim::SceneMoves moves;
  sim::Parts parts;
  sim::Shards shards;
  sim::Collider collider;
  sim::Islands islands;
  sim::Groups groups;
  sim::FarGroups far_groups;
  sim::Leaps leaps;
  sim::MovedBodies moved;
  sim::SingleBodies singles;
  std::unique_ptr<sim::WorldScene> scene;
};
