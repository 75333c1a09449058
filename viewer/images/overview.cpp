// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/overview.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/world/world.hpp"

namespace viewer {

namespace {

/// Part of a vehicle or object that must be inside the image.
struct Subject {
  std::string name;
  int group = -1;
  Eigen::AlignedBox3d box;
  std::vector<sim::Vector3d> points_W;  ///< centers of its parts
  bool is_vehicle = true;
};

Subject subject_of(const sim::PhysicsWorld& physics, const std::string& name, int group) {
  Subject subject{name, group, {}, {}, true};
  for (std::size_t i = 0; i < physics.parts().size(); ++i) {
    if (physics.parts()[i].group != group) continue;
    const auto box = physics.bounds_W(static_cast<int>(i));
    if (!box) continue;
    subject.box.extend(*box);
    subject.points_W.push_back(box->center());
  }
  return subject;
}

std::vector<Subject> subjects_of(const sim::World& world, bool everything) {
  std::vector<Subject> subjects;
  for (const auto& vehicle : world.vehicles())
    subjects.push_back(subject_of(world.physics(), vehicle->name(), vehicle->group()));
  if (subjects.empty() || everything)
    for (const auto& [name, object] : world.objects()) {
      subjects.push_back(subject_of(world.physics(), name, object.group()));
      subjects.back().is_vehicle = false;
    }
  // What has no extent, such as a vehicle without parts, does not fit into any view.
  std::erase_if(subjects, [](const Subject& each) { return each.box.isEmpty(); });
  return subjects;
}

/// Returns the bounding box of the subjects with some of their surroundings.
Eigen::AlignedBox3d framed(const std::vector<Subject>& subjects) {
  Eigen::AlignedBox3d all;
  double max_m = 0;
  for (const Subject& subject : subjects) {
    all.extend(subject.box);
    if (subject.is_vehicle) max_m = std::max(max_m, subject.box.diagonal().norm());
  }
  if (all.isEmpty()) return {sim::Vector3d(-1, -1, 0), sim::Vector3d(1, 1, 1)};
  const double around_m = std::clamp(0.25 * max_m, 0.2, 2.0);
  const sim::Vector3d margin(around_m, around_m, 0);
  return {all.min() - margin, all.max() + margin};
}

/// Moves the camera back from the center of a box until each of its corners is inside the image, with a small margin.
sim::Pose camera_pose_for(const Eigen::AlignedBox3d& box, const sim::Vector3d& back_W,
                          const sim::OpticsConfig& optics) {
  const sim::Pose X_WS = look_at(box.center() + back_W, box.center());
  const double wide = 0.93 * std::tan(0.5 * optics.fov_rad), high = wide * optics.height / optics.width;
  double back_m = 0.5;
  for (int corner = 0; corner < 8; ++corner) {
    const sim::Vector3d p_W = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    const sim::Vector3d p_S = X_WS.linear().transpose() * (p_W - box.center());
    back_m = std::max({back_m, std::abs(p_S.y()) / wide - p_S.x(), std::abs(p_S.z()) / high - p_S.x()});
  }
  return look_at(box.center() + back_m * back_W, box.center());
}

bool is_visible(const sim::World& world, const Subject& subject, const sim::Vector3d& eye_W) {
  sim::RayFilter filter;
  filter.kind = sim::RayKind::light;
  return std::any_of(subject.points_W.begin(), subject.points_W.end(), [&](const sim::Vector3d& point_W) {
    const sim::Vector3d displacement_W = point_W - eye_W;
    const auto hit = world.scene().cast(eye_W, displacement_W.normalized(), displacement_W.norm(), filter);
    return !hit || world.physics().parts()[static_cast<std::size_t>(hit->part)].group == subject.group;
  });
}

/// Returns the width of a vehicle in pixels at its distance.
double pixels_of(const Subject& subject, const sim::Vector3d& eye_W, const sim::OpticsConfig& optics) {
  const double focal_px = 0.5 * optics.width / std::tan(0.5 * optics.fov_rad);
  return focal_px * subject.box.diagonal().norm() / (subject.box.center() - eye_W).norm();
}

}  // namespace

sim::Pose look_at(const sim::Vector3d& eye_W, const sim::Vector3d& look_W) {
  const sim::Vector3d x_W = (look_W - eye_W).normalized();
  const bool upright = std::hypot(x_W.x(), x_W.y()) > 1e-6;
  const sim::Vector3d up_W = upright ? sim::Vector3d::UnitZ() : sim::Vector3d::UnitY();
  sim::Pose X_WS = sim::Pose::Identity();
  const sim::Vector3d y_W = up_W.cross(x_W).normalized();
  X_WS.linear() << x_W, y_W, x_W.cross(y_W);
  X_WS.translation() = eye_W;
  return X_WS;
}

Overview overview_of(const sim::World& world, const sim::OpticsConfig& optics, bool everything) {
  std::vector<Subject> subjects = subjects_of(world, everything);
  const Eigen::AlignedBox3d box = framed(subjects);
  // Objects only need to be framed.
  std::erase_if(subjects, [](const Subject& each) { return !each.is_vehicle; });
  // Clockwise from the south-west, and from other heights when vehicles are hidden.
  const double south_west_rad = std::atan2(-0.75, -0.5);
  std::optional<Overview> best;
  for (const double height_rad : {0.6, 1.0, 0.3, 1.4})
    for (int turn = 0; turn < 8; ++turn) {
      const double azimuth_rad = south_west_rad - turn * std::numbers::pi / 4;
      const sim::Vector3d back_W(std::cos(height_rad) * std::cos(azimuth_rad),
                                 std::cos(height_rad) * std::sin(azimuth_rad), std::sin(height_rad));
      Overview view;
      view.X_WS = camera_pose_for(box, back_W, optics);
      for (const Subject& subject : subjects)
        if (!is_visible(world, subject, view.X_WS.translation())) view.hidden.push_back(subject.name);
      if (best && view.hidden.size() >= best->hidden.size()) continue;
      best = std::move(view);
    }
  // Vehicles that are too small to see.
  constexpr double tiny_px = 6;
  for (const Subject& subject : subjects)
    if (pixels_of(subject, best->X_WS.translation(), optics) < tiny_px) best->tiny.push_back(subject.name);
  return *best;
}

sim::Pose framing_pose(const sim::World& world, const sim::OpticsConfig& optics, const sim::Vector3d& back_W,
                       const std::string& vehicle) {
  std::vector<Subject> subjects = subjects_of(world, false);
  if (!vehicle.empty()) std::erase_if(subjects, [&](const Subject& each) { return each.name != vehicle; });
  return camera_pose_for(framed(subjects), back_W, optics);
}

}  // namespace viewer
