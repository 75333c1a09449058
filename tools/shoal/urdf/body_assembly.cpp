// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/body_assembly.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/math.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/shoal_names.hpp"

namespace tools {

namespace {

/// Inertia of a point of mass 1 at `c` about the origin (parallel axis theorem).
sim::Matrix3d inertia_of_point(const sim::Vector3d& c) {
  return c.squaredNorm() * sim::Matrix3d::Identity() - c * c.transpose();
}

bool same_shape(const RobotShape& a, const RobotShape& b) {
  return a.shape == b.shape && a.size_m == b.size_m && a.radius_m == b.radius_m && a.length_m == b.length_m &&
         a.mesh == b.mesh && a.scale == b.scale && a.X_LS.isApprox(b.X_LS, 1e-9);
}

bool same_shapes(const std::vector<RobotShape>& a, const std::vector<RobotShape>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same_shape(a[i], b[i])) return false;
  return true;
}

constexpr double min_mass_kg = 1e-9;  // of a body in Shoal

/// Checks the moments of inertia: of a solid they are positive, and none is larger than the sum of the others.  One
/// that is zero is not known.
void check_inertia(ImportedBody& body, std::vector<ImportNote>& notes) {
  const std::string who = "body '" + body.name + "'";
  const sim::Vector3d moments = sim::symmetric_eigenvalues(body.inertia_kgm2);
  constexpr double no_inertia_kgm2 = 1e-15;  // that of a grain of dust, 1e-9 kg and 1 mm
  const double rounding = std::max(1e-9 * std::abs(moments[2]), no_inertia_kgm2);
  if (moments[0] < -rounding)
    sim::throw_config_error(
        body.place, who,
        fmt::format("its inertia must be positive definite, got the moments {:.6g}, {:.6g} and {:.6g} kg m^2",
                    moments[0], moments[1], moments[2]));
  body.lacks_inertia = !(moments[0] > rounding);
  if (!body.lacks_inertia && moments[2] > 1.001 * (moments[0] + moments[1]))
    notes.push_back(
        {body.place, fmt::format("{}: no solid has its moments of inertia, {:.6g}, {:.6g} and {:.6g} kg m^2: none is "
                                 "larger than the sum of the others",
                                 who, moments[0], moments[1], moments[2])});
}

}  // namespace

BodyAssembly::BodyAssembly(std::string name, const sim::Pose& X_VB, const sim::SourcePlace& place) {
  body_.name = std::move(name);
  body_.X_VB = X_VB;
  body_.place = place;
}

void BodyAssembly::add(const RobotLink& link, const sim::Pose& X_VL, std::vector<ImportNote>& notes) {
  const sim::Pose X_BL = body_.X_VB.inverse() * X_VL;
  // Mass.
  if (link.inertial && link.inertial->mass_kg > 0) {
    const sim::Pose X_BC = X_BL * link.inertial->X_LC;
    const sim::Vector3d c = X_BC.translation();
    const double mass_kg = link.inertial->mass_kg;
    body_.mass_kg += mass_kg;
    moment_kgm_ += mass_kg * c;
    about_origin_ +=
        X_BC.linear() * link.inertial->inertia_kgm2 * X_BC.linear().transpose() + mass_kg * inertia_of_point(c);
  }
  // Shapes.
  const bool only_visual = link.collisions.empty();
  const bool are_same = same_shapes(link.collisions, link.visuals);
  if (!only_visual && !link.visuals.empty() && !are_same)
    notes.push_back(
        {link.visuals.front().place,
         "link '" + sim::shortened(link.name) + "': <visual> is not imported: the shapes of <collision> are shown"});
  const std::vector<RobotShape>& shapes = only_visual ? link.visuals : link.collisions;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    ImportedPart part{shapes[i], X_BL * shapes[i].X_LS, only_visual};
    if (part.shape.name.empty()) part.shape.name = link.name + (shapes.size() > 1 ? "_" + std::to_string(i + 1) : "");
    if (part.shape.color.empty() && !link.visuals.empty()) part.shape.color = link.visuals[are_same ? i : 0].color;
    body_.parts.push_back(std::move(part));
  }
}

bool BodyAssembly::has_mass() const {
  return body_.mass_kg >= min_mass_kg;
}

void BodyAssembly::allow_no_mass() {
  if (has_mass()) return;
  body_.mass_kg = 1;
  moment_kgm_.setZero();
  about_origin_ = 0.01 * sim::Matrix3d::Identity();
}

ImportedBody BodyAssembly::finish(NoMass no_mass, std::vector<ImportNote>& notes) {
  if (has_mass()) {
    body_.center_of_mass_m = moment_kgm_ / body_.mass_kg;
    body_.inertia_kgm2 = about_origin_ - body_.mass_kg * inertia_of_point(body_.center_of_mass_m);
    check_inertia(body_, notes);
  } else if (no_mass == NoMass::refused) {
    sim::throw_config_error(body_.place, "body '" + body_.name + "'",
                            "must have a mass of at least 1e-9 kg, got " + sim::number_text(body_.mass_kg) +
                                ": its link, or one that a fixed joint attaches to it, needs an <inertial>; `--density "
                                "1000` gives it the mass of its shapes, and `--fixed-base` a root that needs none");
  }
  body_.lacks_mass = !has_mass();
  // Names of parts are unique in their body.
  ShoalNames names("part", {});
  std::vector<ImportNote> ignored;
  for (ImportedPart& part : body_.parts) part.shape.name = names.add(part.shape.name, body_.place, ignored);
  return std::move(body_);
}

}  // namespace tools
